# SPDX-License-Identifier: Apache-2.0
clrt_test(kernel kernel_probe_test)
clrt_test(kernel program_test GTest::gmock)
clrt_test(kernel shared_types_test)
