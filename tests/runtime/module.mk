LEAK_TESTS += tests/runtime/random_programs
TSAN_TESTS += tests/runtime/test_place
LEAK_SH += tests/runtime/test_ranks.sh
ASAN_SH += tests/runtime/test_random.sh tests/runtime/test_report.sh tests/runtime/test_memcheck.sh tests/runtime/test_stuck.sh \
    tests/runtime/test_exit.sh tests/runtime/test_steals.sh tests/runtime/test_migrate.sh
PLAIN_SH += tests/runtime/test_delegate.sh
LONG_SH += tests/runtime/test_random_long.sh tests/runtime/test_memcheck_long.sh tests/runtime/test_threads_long.sh \
    tests/runtime/test_migrate_long.sh
tests_runtime_random_programs_SOURCES = tests/runtime/random_programs.c tests/runtime/random_program.h \
    tests/runtime/random_make.c tests/runtime/random_make.h tests/runtime/random_forks.c tests/runtime/random_nests.c tests/runtime/random_turns.c tests/runtime/random_graphs.c \
    tests/runtime/random_rounds.c tests/runtime/random_laws.c tests/runtime/random_bodies.c tests/runtime/random_print.c \
    tests/runtime/random_cells.c tests/runtime/random_cells.h tests/runtime/random_interpret.c tests/runtime/random_answers.c tests/runtime/random_interpret.h \
    tests/runtime/random_replay.c tests/runtime/random_run.c tests/runtime/random_run.h tests/runtime/random_calls.c \
    tests/runtime/random_memory.c tests/runtime/random_recording.c tests/runtime/random_places.c tests/runtime/random_options.c \
    tests/runtime/random_options.h
tests_runtime_random_programs_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/steals
tests_runtime_steals_LDADD = $(CORE_LIBS)
# The tests of several ranks, in one program: test_ranks.sh says on how many.
RANKS = tests/support/ranks.c tests/support/ranks.h tests/negative/misuse.c tests/negative/misuse.h
check_PROGRAMS += tests/runtime/ranks
tests_runtime_ranks_SOURCES = $(RANKS) tests/runtime/delegation.c tests/runtime/delegation.h tests/runtime/moving.c tests/runtime/moving.h \
    tests/runtime/ranks_acquire.c tests/runtime/ranks_adopt.c tests/runtime/ranks_await.c tests/runtime/ranks_control.c tests/runtime/ranks_cut.c tests/runtime/ranks_delegate.c tests/runtime/ranks_exit.c tests/runtime/ranks_homes.c tests/runtime/ranks_itself.c \
    tests/runtime/ranks_kernels.c tests/runtime/ranks_loaded.c tests/runtime/ranks_mappings.c tests/runtime/ranks_migrate.c tests/runtime/ranks_migrate_values.c \
    tests/runtime/ranks_mpi.c tests/runtime/ranks_parts.c tests/runtime/ranks_plans.c tests/runtime/ranks_prune.c tests/runtime/ranks_replicated.c \
    tests/runtime/ranks_sizes.c tests/runtime/ranks_stuck.c tests/runtime/ranks_stuck_policies.c tests/runtime/ranks_subtrees.c \
    tests/runtime/ranks_tags.c tests/runtime/ranks_tasks.c tests/runtime/ranks_wait_for.c tests/runtime/ranks_wide.c \
    tests/support/said.c tests/support/said.h
tests_runtime_ranks_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/overrun
tests_runtime_overrun_LDADD = $(CORE_LIBS)

if HAVE_CHECK
LEAK_TESTS += tests/runtime/test_window tests/runtime/test_memo tests/runtime/test_memo_ahead tests/runtime/test_late \
    tests/runtime/test_events tests/runtime/test_requests tests/runtime/test_laws tests/runtime/test_sched tests/runtime/test_sched_told \
    tests/runtime/test_makespan tests/runtime/test_check tests/runtime/test_busy tests/runtime/test_environment tests/runtime/test_nested_tasks \
    tests/runtime/test_graphs tests/runtime/test_graphs_change tests/runtime/test_graphs_refused tests/runtime/test_lines
TSAN_TESTS += tests/runtime/test_pool tests/runtime/test_owner tests/runtime/test_comm tests/runtime/test_settle \
    tests/runtime/test_balance tests/runtime/test_monitor tests/runtime/test_passes
PLAIN_TESTS += tests/runtime/test_stack
MEMO_FILES = tests/runtime/repeated.c tests/runtime/repeated.h tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_memo_ahead_SOURCES = tests/runtime/test_memo_ahead.c $(MEMO_FILES)
tests_runtime_test_memo_ahead_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_memo_SOURCES = tests/runtime/test_memo.c $(MEMO_FILES)
tests_runtime_test_memo_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_window_SOURCES = tests/runtime/test_window.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_window_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_environment_SOURCES = tests/runtime/test_environment.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_environment_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_check_SOURCES = tests/runtime/test_check.c tests/support/said.c tests/support/said.h
tests_runtime_test_check_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_nested_tasks_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_busy_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_stack_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_comm_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_owner_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_late_LDADD = tests/support/libunit.a $(CHECK_LIBS)
EXTRA_tests_runtime_test_late_DEPENDENCIES = libduite.la
tests_runtime_test_pool_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_events_SOURCES = tests/runtime/test_events.c tests/runtime/events.h tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_events_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_requests_SOURCES = tests/runtime/test_requests.c tests/runtime/events.h tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_requests_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_laws_SOURCES = tests/runtime/test_laws.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_laws_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_settle_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_balance_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_sched_SOURCES = tests/runtime/test_sched.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_sched_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_sched_told_SOURCES = tests/runtime/test_sched_told.c tests/runtime/passive.h tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_sched_told_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_makespan_SOURCES = tests/runtime/test_makespan.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_makespan_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_monitor_LDADD = $(DUITE_TEST_LIBS)
GRAPHS = tests/runtime/graphs_fixture.c tests/runtime/graphs_fixture.h
tests_runtime_test_graphs_SOURCES = tests/runtime/test_graphs.c $(GRAPHS)
tests_runtime_test_graphs_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_change_SOURCES = tests/runtime/test_graphs_change.c $(GRAPHS)
tests_runtime_test_graphs_refused_SOURCES = tests/runtime/test_graphs_refused.c $(GRAPHS)
tests_runtime_test_graphs_refused_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_change_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_passes_SOURCES = tests/runtime/test_passes.c tests/runtime/rounds_run.c tests/runtime/rounds_run.h
tests_runtime_test_passes_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_lines_SOURCES = tests/runtime/test_lines.c $(GRAPHS)
tests_runtime_test_lines_LDADD = $(DUITE_TEST_LIBS)
endif

tests_runtime_test_place_LDADD = $(DUITE_TEST_LIBS)
