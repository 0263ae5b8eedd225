if HAVE_CHECK
ASAN_TESTS += tests/cloth/untangle/test_untangle
tests_cloth_untangle_test_untangle_SOURCES = tests/cloth/untangle/test_untangle.c
tests_cloth_untangle_test_untangle_LDADD = $(CLOTH_TEST_LIBS)
endif
