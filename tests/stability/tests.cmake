# SPDX-License-Identifier: Apache-2.0
find_package(embree 3 REQUIRED)
clrt_test(stability degenerate_test)
clrt_test(stability embree_test embree)
clrt_test(stability flips_test)
target_compile_definitions(flips_test PRIVATE CLRT_SCENES_FOLDER="${PROJECT_SOURCE_DIR}/scenes")
clrt_test(stability odd_rays_test)
clrt_test(stability watertight_test)
if(TARGET clrt_bench_core)
  clrt_test(stability bench_watertight_test clrt_bench_core)
endif()

# The catalogue, a ctest entry for the cases of some letters: so they run side by side and none runs long.
add_executable(catalogue_test stability/catalogue_test.cpp)
target_link_libraries(catalogue_test PRIVATE clrt_stability_core clrt_test_support GTest::gtest GTest::gtest_main)
clrt_compile_as_test(catalogue_test)
foreach(letters IN ITEMS I SC DG TRF PLE AB KMXV)
  # GoogleTest's patterns know no sets of characters: one pattern a letter.
  string(REGEX REPLACE "(.)" "Case/Catalogue.Holds/\\1*:" patterns ${letters})
  add_test(NAME stability.catalogue_${letters} COMMAND catalogue_test "--gtest_filter=${patterns}CatalogueTable.*")
  set_tests_properties(stability.catalogue_${letters} PROPERTIES LABELS stability TIMEOUT 600)
endforeach()
