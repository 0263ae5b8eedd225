if HAVE_CHECK
ASAN_TESTS += tests/cloth/base/test_axes tests/cloth/base/test_sets
tests_cloth_base_test_axes_SOURCES = tests/cloth/base/test_axes.c
tests_cloth_base_test_axes_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_base_test_sets_SOURCES = tests/cloth/base/test_sets.c
tests_cloth_base_test_sets_LDADD = $(CLOTH_TEST_LIBS)
endif
