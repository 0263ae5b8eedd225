check_PROGRAMS += tests/runtime/random_programs
tests_runtime_random_programs_SOURCES = tests/runtime/random_programs.c tests/runtime/random_program.h \
    tests/runtime/random_make.c tests/runtime/random_make.h tests/runtime/random_graphs.c tests/runtime/random_cells.c \
    tests/runtime/random_cells.h tests/runtime/random_print.c tests/runtime/random_laws.c \
    tests/runtime/random_bodies.c tests/runtime/random_interpret.c tests/runtime/random_run.c tests/runtime/random_run.h \
    tests/runtime/random_places.c tests/runtime/random_rounds.c
tests_runtime_random_programs_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_sizes
tests_runtime_ranks_sizes_SOURCES = tests/runtime/ranks_sizes.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_sizes_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_tasks tests/runtime/steals
tests_runtime_ranks_tasks_SOURCES = tests/runtime/ranks_tasks.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_tasks_LDADD = $(CORE_LIBS)
tests_runtime_steals_SOURCES = tests/runtime/steals.c
tests_runtime_steals_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_policy_tasks.sh
TESTS += tests/runtime/test_policy_tasks.sh
check_PROGRAMS += tests/runtime/ranks_homes
tests_runtime_ranks_homes_SOURCES = tests/runtime/ranks_homes.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_homes_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_replicated
tests_runtime_ranks_replicated_SOURCES = tests/runtime/ranks_replicated.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_replicated_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_plans
tests_runtime_ranks_plans_SOURCES = tests/runtime/ranks_plans.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_plans_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_mpi
tests_runtime_ranks_mpi_SOURCES = tests/runtime/ranks_mpi.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_mpi_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_mpi.sh
TESTS += tests/runtime/test_mpi.sh
check_PROGRAMS += tests/runtime/ranks_control
tests_runtime_ranks_control_SOURCES = tests/runtime/ranks_control.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_control_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_control.sh
TESTS += tests/runtime/test_control.sh
dist_check_SCRIPTS += tests/runtime/test_plans.sh
TESTS += tests/runtime/test_plans.sh
check_PROGRAMS += tests/runtime/nested_programs
tests_runtime_nested_programs_SOURCES = tests/runtime/nested_programs.c tests/runtime/nested_program.h \
    tests/runtime/nested_make.c tests/runtime/nested_interpret.c tests/runtime/nested_values.c
tests_runtime_nested_programs_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_random.sh tests/runtime/test_random_long.sh tests/runtime/test_sizes.sh tests/runtime/test_homes.sh \
    tests/runtime/test_nested.sh tests/runtime/test_memcheck.sh tests/runtime/test_memcheck_long.sh tests/runtime/test_threads_long.sh
TESTS += tests/runtime/random_programs tests/runtime/test_random.sh tests/runtime/test_sizes.sh tests/runtime/test_homes.sh \
	tests/runtime/test_nested.sh \
    tests/runtime/test_memcheck.sh
LONG_TESTS += tests/runtime/test_random_long.sh tests/runtime/test_memcheck_long.sh tests/runtime/test_threads_long.sh
SAID_FILES = tests/support/said.c tests/support/said.h
check_PROGRAMS += tests/runtime/ranks_stuck_policies
tests_runtime_ranks_stuck_policies_SOURCES = tests/runtime/ranks_stuck_policies.c tests/negative/misuse.c tests/negative/misuse.h $(SAID_FILES)
tests_runtime_ranks_stuck_policies_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_mappings
tests_runtime_ranks_mappings_SOURCES = tests/runtime/ranks_mappings.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_mappings_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_mappings.sh
TESTS += tests/runtime/test_mappings.sh
check_PROGRAMS += tests/runtime/overrun
tests_runtime_overrun_SOURCES = tests/runtime/overrun.c
tests_runtime_overrun_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_stuck
tests_runtime_ranks_stuck_SOURCES = tests/runtime/ranks_stuck.c
tests_runtime_ranks_stuck_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_stuck.sh
TESTS += tests/runtime/test_stuck.sh
check_PROGRAMS += tests/runtime/ranks_loaded
tests_runtime_ranks_loaded_SOURCES = tests/runtime/ranks_loaded.c
tests_runtime_ranks_loaded_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_loaded.sh
TESTS += tests/runtime/test_loaded.sh
check_PROGRAMS += tests/runtime/ranks_exit
tests_runtime_ranks_exit_SOURCES = tests/runtime/ranks_exit.c
tests_runtime_ranks_exit_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_exit.sh
TESTS += tests/runtime/test_exit.sh

check_PROGRAMS += tests/runtime/ranks_tags
tests_runtime_ranks_tags_SOURCES = tests/runtime/ranks_tags.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_tags_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_wide
tests_runtime_ranks_wide_SOURCES = tests/runtime/ranks_wide.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_wide_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_wide.sh
TESTS += tests/runtime/test_wide.sh
check_PROGRAMS += tests/runtime/ranks_prune
tests_runtime_ranks_prune_SOURCES = tests/runtime/ranks_prune.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_ranks_prune_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_prune.sh
TESTS += tests/runtime/test_prune.sh
DELEGATION_FILES = tests/runtime/delegation.c tests/runtime/delegation.h tests/negative/misuse.c tests/negative/misuse.h
check_PROGRAMS += tests/runtime/ranks_delegate
tests_runtime_ranks_delegate_SOURCES = tests/runtime/ranks_delegate.c $(DELEGATION_FILES)
tests_runtime_ranks_delegate_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/runtime/ranks_subtrees
tests_runtime_ranks_subtrees_SOURCES = tests/runtime/ranks_subtrees.c $(DELEGATION_FILES)
tests_runtime_ranks_subtrees_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_delegate.sh
TESTS += tests/runtime/test_delegate.sh
MOVING = tests/runtime/moving.c tests/runtime/moving.h tests/negative/misuse.c tests/negative/misuse.h
check_PROGRAMS += tests/runtime/ranks_migrate tests/runtime/ranks_migrate_values
tests_runtime_ranks_migrate_SOURCES = tests/runtime/ranks_migrate.c $(MOVING)
tests_runtime_ranks_migrate_LDADD = $(CORE_LIBS)
tests_runtime_ranks_migrate_values_SOURCES = tests/runtime/ranks_migrate_values.c $(MOVING)
tests_runtime_ranks_migrate_values_LDADD = $(CORE_LIBS)
dist_check_SCRIPTS += tests/runtime/test_migrate.sh tests/runtime/test_migrate_long.sh
TESTS += tests/runtime/test_migrate.sh
LONG_TESTS += tests/runtime/test_migrate_long.sh

if HAVE_CHECK
AHEAD_TESTS = tests/runtime/test_window tests/runtime/test_memo tests/runtime/test_memo_ahead
check_PROGRAMS += $(AHEAD_TESTS)
TESTS += $(AHEAD_TESTS)
MEMO_FILES = tests/runtime/repeated.c tests/runtime/repeated.h tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_memo_ahead_SOURCES = tests/runtime/test_memo_ahead.c $(MEMO_FILES)
tests_runtime_test_memo_ahead_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_memo_SOURCES = tests/runtime/test_memo.c $(MEMO_FILES)
tests_runtime_test_memo_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_window_SOURCES = tests/runtime/test_window.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_window_LDADD = $(DUITE_TEST_LIBS)
RUNTIME_TESTS = tests/runtime/test_late tests/runtime/test_pool tests/runtime/test_owner tests/runtime/test_offload_names \
	tests/runtime/test_laws tests/runtime/test_settle tests/runtime/test_balance tests/runtime/test_sched \
	tests/runtime/test_sched_knowing tests/runtime/test_sched_told tests/runtime/test_makespan tests/runtime/test_monitor \
	tests/runtime/test_check tests/runtime/test_environment \
    tests/runtime/test_nested_tasks tests/runtime/test_stack tests/runtime/test_busy tests/runtime/test_graphs tests/runtime/test_graphs_change \
    tests/runtime/test_graphs_refused
check_PROGRAMS += $(RUNTIME_TESTS)
TESTS += $(RUNTIME_TESTS)
tests_runtime_test_environment_SOURCES = tests/runtime/test_environment.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_environment_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_check_SOURCES = tests/runtime/test_check.c
tests_runtime_test_check_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_nested_tasks_SOURCES = tests/runtime/test_nested_tasks.c
tests_runtime_test_nested_tasks_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_busy_SOURCES = tests/runtime/test_busy.c
tests_runtime_test_busy_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_stack_SOURCES = tests/runtime/test_stack.c
tests_runtime_test_stack_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_offload_names_SOURCES = tests/runtime/test_offload_names.c
tests_runtime_test_offload_names_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_owner_SOURCES = tests/runtime/test_owner.c
tests_runtime_test_owner_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_late_SOURCES = tests/runtime/test_late.c
tests_runtime_test_late_LDADD = tests/support/libunit.a $(CHECK_LIBS)
EXTRA_tests_runtime_test_late_DEPENDENCIES = libduite.la
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
tests_runtime_test_sched_told_SOURCES = tests/runtime/test_sched_told.c tests/runtime/passive.h tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_sched_told_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_sched_knowing_SOURCES = tests/runtime/test_sched_knowing.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_sched_knowing_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_makespan_SOURCES = tests/runtime/test_makespan.c tests/negative/misuse.c tests/negative/misuse.h
tests_runtime_test_makespan_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_monitor_SOURCES = tests/runtime/test_monitor.c
tests_runtime_test_monitor_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_SOURCES = tests/runtime/test_graphs.c
tests_runtime_test_graphs_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_change_SOURCES = tests/runtime/test_graphs_change.c \
    tests/runtime/graphs_fixture.c tests/runtime/graphs_fixture.h
tests_runtime_test_graphs_refused_SOURCES = tests/runtime/test_graphs_refused.c \
    tests/runtime/graphs_fixture.c tests/runtime/graphs_fixture.h
tests_runtime_test_graphs_refused_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graphs_change_LDADD = $(DUITE_TEST_LIBS)
PASSES_TESTS = tests/runtime/test_passes tests/runtime/test_passes_random tests/runtime/test_emit tests/runtime/test_graph_sums \
    tests/runtime/test_lines
check_PROGRAMS += $(PASSES_TESTS)
TESTS += $(PASSES_TESTS)
tests_runtime_test_passes_SOURCES = tests/runtime/test_passes.c tests/runtime/rounds.c tests/runtime/rounds.h
tests_runtime_test_passes_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_passes_random_SOURCES = tests/runtime/test_passes_random.c tests/runtime/rounds.c tests/runtime/rounds.h \
    tests/runtime/rounds_run.c tests/runtime/rounds_run.h
tests_runtime_test_passes_random_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_emit_SOURCES = tests/runtime/test_emit.c
tests_runtime_test_emit_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_graph_sums_SOURCES = tests/runtime/test_graph_sums.c
tests_runtime_test_graph_sums_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_lines_SOURCES = tests/runtime/test_lines.c
tests_runtime_test_lines_LDADD = $(DUITE_TEST_LIBS)
endif

check_PROGRAMS += tests/runtime/test_containers tests/runtime/test_place tests/runtime/test_reduce
TESTS += tests/runtime/test_containers tests/runtime/test_place tests/runtime/test_reduce
tests_runtime_test_containers_SOURCES = tests/runtime/test_containers.c
tests_runtime_test_containers_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_place_SOURCES = tests/runtime/test_place.c
tests_runtime_test_place_LDADD = $(DUITE_TEST_LIBS)
tests_runtime_test_reduce_SOURCES = tests/runtime/test_reduce.c
tests_runtime_test_reduce_LDADD = $(DUITE_TEST_LIBS)
