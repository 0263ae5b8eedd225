if HAVE_CHECK
ASAN_TESTS += tests/cloth/untangle/test_untangle
endif
