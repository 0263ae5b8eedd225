if HAVE_CHECK
SOLVE_TEST_SYSTEM = tests/cloth/solve/system.c tests/cloth/solve/system.h
SOLVE_TEST_TWO_LEVEL = $(SOLVE_TEST_SYSTEM) tests/cloth/solve/two_level.c tests/cloth/solve/two_level.h
ASAN_TESTS += tests/cloth/solve/test_pass tests/cloth/solve/test_cg tests/cloth/solve/test_format \
    tests/cloth/solve/test_correction tests/cloth/solve/test_local tests/cloth/solve/test_coarse tests/cloth/solve/test_patches \
    tests/cloth/solve/test_preconditioned tests/cloth/solve/test_levels
tests_cloth_solve_test_format_SOURCES = tests/cloth/solve/test_format.c $(SOLVE_TEST_SYSTEM)
tests_cloth_solve_test_patches_SOURCES = tests/cloth/solve/test_patches.c $(SOLVE_TEST_SYSTEM)
tests_cloth_solve_test_local_SOURCES = tests/cloth/solve/test_local.c $(SOLVE_TEST_SYSTEM)
tests_cloth_solve_test_coarse_SOURCES = tests/cloth/solve/test_coarse.c $(SOLVE_TEST_TWO_LEVEL)
tests_cloth_solve_test_preconditioned_SOURCES = tests/cloth/solve/test_preconditioned.c $(SOLVE_TEST_TWO_LEVEL)
endif
