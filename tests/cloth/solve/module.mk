if HAVE_CHECK
check_PROGRAMS += tests/cloth/solve/test_block
tests_cloth_solve_test_block_SOURCES = tests/cloth/solve/test_block.c
tests_cloth_solve_test_block_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/solve/test_block
endif
