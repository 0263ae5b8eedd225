LEAK_SH += tests/tools/test_trace.sh
ASAN_SH += tests/tools/test_vite.sh tests/tools/test_chart.sh
PLAIN_SH += tests/tools/test_compare.sh tests/tools/test_compare_any.sh tests/tools/test_python.sh tests/tools/test_simgrid.sh
check_PROGRAMS += tests/tools/synthetic
tests_tools_synthetic_SOURCES = tests/tools/synthetic.c tests/support/trace_file.c tests/support/trace_file.h
EXTRA_DIST += tests/tools/simgrid.cpp
if HAVE_CHECK
TOOLS_TEST_LIBS = tests/support/libunit.a $(TOOLS_LIBS) $(CHECK_LIBS)
LEAK_TESTS += tests/tools/test_traced
ASAN_TESTS += tests/tools/test_predict tests/tools/test_predict_replays tests/tools/test_predict_costs tests/tools/test_predict_refused \
    tests/tools/test_predict_rounds tests/tools/test_platform tests/tools/test_bounds tests/tools/test_shares tests/tools/test_load
PREDICTED_FILES = tests/tools/predicted.c tests/tools/predicted.h tests/support/trace_file.c tests/support/trace_file.h
tests_tools_test_predict_SOURCES = tests/tools/test_predict.c $(PREDICTED_FILES)
tests_tools_test_predict_LDADD = $(TOOLS_TEST_LIBS)
EXTRA_tests_tools_test_predict_DEPENDENCIES = duite-predict$(EXEEXT) # whose warning it reads
tests_tools_test_predict_costs_SOURCES = tests/tools/test_predict_costs.c $(PREDICTED_FILES)
tests_tools_test_predict_costs_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_platform_SOURCES = tests/tools/test_platform.c $(PREDICTED_FILES)
tests_tools_test_platform_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_predict_refused_SOURCES = tests/tools/test_predict_refused.c $(PREDICTED_FILES)
tests_tools_test_predict_refused_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_predict_replays_SOURCES = tests/tools/test_predict_replays.c tests/runtime/passive.h $(PREDICTED_FILES)
tests_tools_test_predict_replays_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_shares_LDADD = tests/support/libunit.a $(CHART_LIBS) $(TOOLS_LIBS) $(CHECK_LIBS)
tests_tools_test_bounds_SOURCES = tests/tools/test_bounds.c $(PREDICTED_FILES)
tests_tools_test_bounds_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_traced_SOURCES = tests/tools/test_traced.c tests/negative/misuse.c tests/negative/misuse.h
tests_tools_test_traced_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_predict_rounds_SOURCES = tests/tools/test_predict_rounds.c tests/negative/misuse.c tests/negative/misuse.h
tests_tools_test_predict_rounds_LDADD = $(TOOLS_TEST_LIBS)
tests_tools_test_load_LDADD = $(TOOLS_TEST_LIBS)
endif
