if HAVE_CHECK
ASAN_TESTS += tests/cloth/test_progress tests/cloth/test_summary_time
tests_cloth_test_progress_SOURCES = tests/cloth/test_progress.c cloth/app/run/progress.c cloth/app/run/progress.h
tests_cloth_test_summary_time_SOURCES = tests/cloth/test_summary_time.c cloth/app/report/summary_time.c cloth/app/report/summary.h
endif
