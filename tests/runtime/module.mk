check_PROGRAMS += tests/runtime/random_programs
tests_runtime_random_programs_SOURCES = tests/runtime/random_programs.c tests/runtime/random_program.h \
    tests/runtime/random_make.c tests/runtime/random_make.h tests/runtime/random_graphs.c tests/runtime/random_cells.c \
    tests/runtime/random_cells.h tests/runtime/random_print.c tests/runtime/random_views.c tests/runtime/random_laws.c \
    tests/runtime/random_bodies.c tests/runtime/random_interpret.c tests/runtime/random_run.c tests/runtime/random_run.h \
    tests/runtime/random_places.c
tests_runtime_random_programs_LDADD = libduite_core.la
check_PROGRAMS += tests/runtime/ranks_sizes
tests_runtime_ranks_sizes_SOURCES = tests/runtime/ranks_sizes.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_sizes_LDADD = libduite_core.la
check_PROGRAMS += tests/runtime/ranks_tasks tests/runtime/steals
tests_runtime_ranks_tasks_SOURCES = tests/runtime/ranks_tasks.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_tasks_LDADD = libduite_core.la
tests_runtime_steals_SOURCES = tests/runtime/steals.c
tests_runtime_steals_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_policy_tasks.sh
TESTS += tests/runtime/test_policy_tasks.sh
check_PROGRAMS += tests/runtime/ranks_homes
tests_runtime_ranks_homes_SOURCES = tests/runtime/ranks_homes.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_homes_LDADD = libduite_core.la
check_PROGRAMS += tests/runtime/ranks_views
tests_runtime_ranks_views_SOURCES = tests/runtime/ranks_views.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_views_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_ranks_views.sh
TESTS += tests/runtime/test_ranks_views.sh
check_PROGRAMS += tests/runtime/ranks_replicated
tests_runtime_ranks_replicated_SOURCES = tests/runtime/ranks_replicated.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_replicated_LDADD = libduite_core.la
check_PROGRAMS += tests/runtime/ranks_plans
tests_runtime_ranks_plans_SOURCES = tests/runtime/ranks_plans.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_plans_LDADD = libduite_core.la
check_PROGRAMS += tests/runtime/ranks_mpi
tests_runtime_ranks_mpi_SOURCES = tests/runtime/ranks_mpi.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_mpi_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_mpi.sh
TESTS += tests/runtime/test_mpi.sh
dist_check_SCRIPTS += tests/runtime/test_plans.sh
TESTS += tests/runtime/test_plans.sh
check_PROGRAMS += tests/runtime/nested_programs
tests_runtime_nested_programs_SOURCES = tests/runtime/nested_programs.c tests/runtime/nested_program.h \
    tests/runtime/nested_make.c tests/runtime/nested_interpret.c
tests_runtime_nested_programs_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_random.sh tests/runtime/test_random_long.sh tests/runtime/test_sizes.sh tests/runtime/test_homes.sh \
    tests/runtime/test_nested.sh tests/runtime/test_memcheck.sh tests/runtime/test_memcheck_long.sh tests/runtime/test_threads_long.sh
TESTS += tests/runtime/random_programs tests/runtime/test_random.sh tests/runtime/test_sizes.sh tests/runtime/test_homes.sh tests/runtime/test_nested.sh \
    tests/runtime/test_memcheck.sh
LONG_TESTS += tests/runtime/test_random_long.sh tests/runtime/test_memcheck_long.sh tests/runtime/test_threads_long.sh
check_PROGRAMS += tests/runtime/ranks_guard
tests_runtime_ranks_guard_SOURCES = tests/runtime/ranks_guard.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_guard_LDADD = libduite_core.la
check_PROGRAMS += tests/runtime/ranks_mappings
tests_runtime_ranks_mappings_SOURCES = tests/runtime/ranks_mappings.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_mappings_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_mappings.sh
TESTS += tests/runtime/test_mappings.sh
dist_check_SCRIPTS += tests/runtime/test_guard.sh
TESTS += tests/runtime/test_guard.sh
check_PROGRAMS += tests/runtime/ranks_stuck
tests_runtime_ranks_stuck_SOURCES = tests/runtime/ranks_stuck.c
tests_runtime_ranks_stuck_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_stuck.sh
TESTS += tests/runtime/test_stuck.sh
check_PROGRAMS += tests/runtime/ranks_exit
tests_runtime_ranks_exit_SOURCES = tests/runtime/ranks_exit.c
tests_runtime_ranks_exit_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_exit.sh
TESTS += tests/runtime/test_exit.sh

check_PROGRAMS += tests/runtime/ranks_prune
tests_runtime_ranks_prune_SOURCES = tests/runtime/ranks_prune.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_prune_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_prune.sh
TESTS += tests/runtime/test_prune.sh
check_PROGRAMS += tests/runtime/ranks_delegate
tests_runtime_ranks_delegate_SOURCES = tests/runtime/ranks_delegate.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_delegate_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_delegate.sh
TESTS += tests/runtime/test_delegate.sh
MOVING = tests/runtime/moving.c tests/runtime/moving.h tests/negative/misuse.c tests/negative/misuse.h
check_PROGRAMS += tests/runtime/ranks_migrate tests/runtime/ranks_migrate_values
tests_runtime_ranks_migrate_SOURCES = tests/runtime/ranks_migrate.c $(MOVING)
tests_runtime_ranks_migrate_LDADD = libduite_core.la
tests_runtime_ranks_migrate_values_SOURCES = tests/runtime/ranks_migrate_values.c $(MOVING)
tests_runtime_ranks_migrate_values_LDADD = libduite_core.la
dist_check_SCRIPTS += tests/runtime/test_migrate.sh tests/runtime/test_migrate_long.sh
TESTS += tests/runtime/test_migrate.sh
LONG_TESTS += tests/runtime/test_migrate_long.sh
dist_check_SCRIPTS += tests/runtime/test_trace.sh
dist_check_SCRIPTS += tests/runtime/test_vite.sh
TESTS += tests/runtime/test_trace.sh
TESTS += tests/runtime/test_vite.sh

if HAVE_CHECK
AHEAD_TESTS = tests/runtime/test_window tests/runtime/test_rename
check_PROGRAMS += $(AHEAD_TESTS)
TESTS += $(AHEAD_TESTS)
tests_runtime_test_rename_SOURCES = tests/runtime/test_rename.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_rename_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_window_SOURCES = tests/runtime/test_window.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_window_LDADD = $(DUITE_TEST_LIBS)
RUNTIME_TESTS = tests/runtime/test_predict tests/runtime/test_predict_replays tests/runtime/test_pool tests/runtime/test_laws tests/runtime/test_settle tests/runtime/test_balance tests/runtime/test_sched tests/runtime/test_sched_knowing tests/runtime/test_makespan tests/runtime/test_guard tests/runtime/test_traced tests/runtime/test_check tests/runtime/test_environment \
    tests/runtime/test_nested_tasks tests/runtime/test_graphs tests/runtime/test_graphs_change tests/runtime/test_graphs_refused tests/runtime/test_graph_print tests/runtime/test_views
check_PROGRAMS += $(RUNTIME_TESTS)
TESTS += $(RUNTIME_TESTS)
FORETELL_FILES = tests/runtime/foretell.c tests/runtime/foretell.h tests/runtime/trace_file.c tests/runtime/trace_file.h
tests_runtime_test_predict_SOURCES = tests/runtime/test_predict.c $(FORETELL_FILES)
tests_runtime_test_predict_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_predict_replays_SOURCES = tests/runtime/test_predict_replays.c $(FORETELL_FILES)
tests_runtime_test_predict_replays_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_environment_SOURCES = tests/runtime/test_environment.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_environment_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_check_SOURCES = tests/runtime/test_check.c
tests_runtime_test_check_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_nested_tasks_SOURCES = tests/runtime/test_nested_tasks.c
tests_runtime_test_nested_tasks_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_pool_SOURCES = tests/runtime/test_pool.c
tests_runtime_test_pool_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_laws_SOURCES = tests/runtime/test_laws.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_laws_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_settle_SOURCES = tests/runtime/test_settle.c
tests_runtime_test_settle_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_balance_SOURCES = tests/runtime/test_balance.c
tests_runtime_test_balance_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_sched_SOURCES = tests/runtime/test_sched.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_sched_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_sched_knowing_SOURCES = tests/runtime/test_sched_knowing.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_sched_knowing_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_makespan_SOURCES = tests/runtime/test_makespan.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_makespan_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_traced_SOURCES = tests/runtime/test_traced.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_traced_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_guard_SOURCES = tests/runtime/test_guard.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_guard_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_SOURCES = tests/runtime/test_graphs.c
tests_runtime_test_graphs_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_change_SOURCES = tests/runtime/test_graphs_change.c \
    tests/runtime/graphs_fixture.c tests/runtime/graphs_fixture.h
tests_runtime_test_graphs_refused_SOURCES = tests/runtime/test_graphs_refused.c \
    tests/runtime/graphs_fixture.c tests/runtime/graphs_fixture.h
tests_runtime_test_graphs_refused_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_views_SOURCES = tests/runtime/test_views.c
tests_runtime_test_views_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graph_print_SOURCES = tests/runtime/test_graph_print.c
tests_runtime_test_graph_print_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_change_LDADD = $(DUITE_TEST_LIBS)
endif
