# SPDX-License-Identifier: Apache-2.0
find_package(embree 3 REQUIRED)
clrt_test(stability degenerate_test)
clrt_test(stability embree_test embree)
clrt_test(stability odd_rays_test)
clrt_test(stability offset_test)
clrt_test(stability watertight_test)
