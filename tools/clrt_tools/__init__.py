# SPDX-License-Identifier: Apache-2.0
"""What clrt-compare and clrt-study share: reading pictures, metrics, tests, drawings."""
