if HAVE_CHECK
ASAN_TESTS += tests/cloth/test_progress tests/cloth/test_summary_time
tests_cloth_test_progress_SOURCES = tests/cloth/test_progress.c cloth/progress.c cloth/progress.h
tests_cloth_test_summary_time_SOURCES = tests/cloth/test_summary_time.c cloth/summary_time.c cloth/summary_time.h
endif
