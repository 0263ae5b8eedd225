if HAVE_CHECK
ASAN_TESTS += tests/cloth/base/test_axes tests/cloth/base/test_sets
endif
