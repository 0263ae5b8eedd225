check_PROGRAMS += tests/bench/liar
tests_bench_liar_SOURCES = tests/bench/liar.c bench/serve.c bench/serve.h
if HAVE_CHECK
check_PROGRAMS += tests/bench/test_problem
tests_bench_test_problem_SOURCES = tests/bench/test_problem.c bench/problem.c bench/problem.h bench/tiles.c bench/tiles.h
tests_bench_test_problem_LDADD = tests/support/libunit.a $(CHECK_LIBS) -lm
check_PROGRAMS += tests/bench/test_sheet
tests_bench_test_sheet_SOURCES = tests/bench/test_sheet.c
tests_bench_test_sheet_LDADD = tests/support/libunit.a $(BENCH_LIBRARY) $(CHECK_LIBS)
check_PROGRAMS += tests/bench/test_states
tests_bench_test_states_SOURCES = tests/bench/test_states.c
tests_bench_test_states_LDADD = tests/support/libunit.a $(BENCH_LIBRARY) $(CHECK_LIBS)
TESTS += tests/bench/test_problem tests/bench/test_sheet tests/bench/test_states
endif
EXTRA_DIST += tests/bench/bench.sh
dist_check_SCRIPTS += tests/bench/test_output.sh tests/bench/test_bench.sh tests/bench/test_cg.sh \
	tests/bench/test_contact.sh tests/bench/test_experiments.sh tests/bench/test_garments.sh tests/bench/test_physics.sh \
	tests/bench/test_ranks.sh tests/bench/test_scale.sh
TESTS += tests/bench/test_bench.sh tests/bench/test_cg.sh tests/bench/test_contact.sh \
	tests/bench/test_experiments.sh tests/bench/test_garments.sh tests/bench/test_output.sh tests/bench/test_physics.sh \
	tests/bench/test_ranks.sh tests/bench/test_scale.sh
dist_check_SCRIPTS += tests/bench/test_experiments_long.sh
LONG_TESTS += tests/bench/test_experiments_long.sh
dist_check_SCRIPTS += tests/bench/test_predict.sh
TESTS += tests/bench/test_predict.sh
