if HAVE_CHECK
SOLVE_TEST_SYSTEM = tests/cloth/solve/system.c tests/cloth/solve/system.h
SOLVE_TEST_TWO_LEVEL = $(SOLVE_TEST_SYSTEM) tests/cloth/solve/two_level.c tests/cloth/solve/two_level.h
ASAN_TESTS += tests/cloth/solve/test_block tests/cloth/solve/test_pass tests/cloth/solve/test_cg tests/cloth/solve/test_format \
    tests/cloth/solve/test_correction tests/cloth/solve/test_local tests/cloth/solve/test_coarse tests/cloth/solve/test_patches \
    tests/cloth/solve/test_preconditioned tests/cloth/solve/test_levels
tests_cloth_solve_test_correction_SOURCES = tests/cloth/solve/test_correction.c
tests_cloth_solve_test_correction_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_format_SOURCES = tests/cloth/solve/test_format.c $(SOLVE_TEST_SYSTEM)
tests_cloth_solve_test_format_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_block_SOURCES = tests/cloth/solve/test_block.c
tests_cloth_solve_test_block_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_pass_SOURCES = tests/cloth/solve/test_pass.c
tests_cloth_solve_test_pass_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_cg_SOURCES = tests/cloth/solve/test_cg.c
tests_cloth_solve_test_cg_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_patches_SOURCES = tests/cloth/solve/test_patches.c $(SOLVE_TEST_SYSTEM)
tests_cloth_solve_test_patches_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_local_SOURCES = tests/cloth/solve/test_local.c $(SOLVE_TEST_SYSTEM)
tests_cloth_solve_test_local_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_coarse_SOURCES = tests/cloth/solve/test_coarse.c $(SOLVE_TEST_TWO_LEVEL)
tests_cloth_solve_test_coarse_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_preconditioned_SOURCES = tests/cloth/solve/test_preconditioned.c $(SOLVE_TEST_TWO_LEVEL)
tests_cloth_solve_test_preconditioned_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_levels_SOURCES = tests/cloth/solve/test_levels.c
tests_cloth_solve_test_levels_LDADD = $(CLOTH_TEST_LIBS)
endif
