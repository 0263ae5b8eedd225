if HAVE_CHECK
check_PROGRAMS += tests/cloth/solve/test_block tests/cloth/solve/test_pass tests/cloth/solve/test_cg
tests_cloth_solve_test_block_SOURCES = tests/cloth/solve/test_block.c
tests_cloth_solve_test_block_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_pass_SOURCES = tests/cloth/solve/test_pass.c
tests_cloth_solve_test_pass_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_solve_test_cg_SOURCES = tests/cloth/solve/test_cg.c
tests_cloth_solve_test_cg_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/solve/test_block tests/cloth/solve/test_pass tests/cloth/solve/test_cg
endif
