LONG_SH += tests/bench/test_output.sh tests/bench/test_bench.sh tests/bench/test_cg.sh tests/bench/test_contact.sh \
    tests/bench/test_experiments.sh tests/bench/test_garments.sh tests/bench/test_physics.sh tests/bench/test_ranks.sh \
    tests/bench/test_scale.sh tests/bench/test_taskbench.sh tests/bench/test_experiments_long.sh tests/bench/test_predict.sh
check_PROGRAMS += tests/bench/liar
tests_bench_liar_SOURCES = tests/bench/liar.c bench/serve.c bench/serve.h
tests_bench_liar_LDADD =
if HAVE_CHECK
PLAIN_TESTS += tests/bench/test_problem tests/bench/test_sheet tests/bench/test_states
tests_bench_test_problem_SOURCES = tests/bench/test_problem.c bench/forks.c bench/forks.h bench/problem.c bench/problem.h bench/tiles.c bench/tiles.h
tests_bench_test_problem_LDADD = tests/support/libunit.a $(CHECK_LIBS) -lm
tests_bench_test_sheet_LDADD = tests/support/libunit.a $(BENCH_LIBRARY) $(CHECK_LIBS)
tests_bench_test_states_LDADD = tests/support/libunit.a $(BENCH_LIBRARY) $(CHECK_LIBS)
endif
EXTRA_DIST += tests/bench/bench.sh
