MISUSE = tests/negative/misuse.c tests/negative/misuse.h
LEAK_SH += tests/negative/test_ranks.sh
ASAN_SH += tests/negative/test_lost.sh tests/negative/test_environment.sh
LONG_SH += tests/negative/test_lost_long.sh tests/negative/test_memory_long.sh
check_PROGRAMS += tests/negative/ranks_failures tests/negative/ranks_different tests/negative/ranks_groups \
                  tests/negative/ranks_memory tests/negative/ranks_memory_graphs tests/negative/ranks_system tests/negative/ranks_blocking
tests_negative_ranks_failures_SOURCES = tests/negative/ranks_failures.c $(MISUSE)
tests_negative_ranks_failures_LDADD = $(CORE_LIBS)
tests_negative_ranks_different_SOURCES = tests/negative/ranks_different.c $(MISUSE)
tests_negative_ranks_different_LDADD = $(CORE_LIBS)
tests_negative_ranks_blocking_SOURCES = tests/negative/ranks_blocking.c $(MISUSE)
tests_negative_ranks_blocking_LDADD = $(CORE_LIBS)
tests_negative_ranks_groups_SOURCES = tests/negative/ranks_groups.c $(MISUSE)
tests_negative_ranks_groups_LDADD = $(CORE_LIBS)
STARVE = tests/negative/starve.c tests/negative/starve.h
STARVE_WRAPS = -Wl,--wrap=malloc,--wrap=realloc,--wrap=aligned_alloc,--wrap=base_pool_take_more,--wrap=base_pool_give_more
tests_negative_ranks_memory_SOURCES = tests/negative/ranks_memory.c $(MISUSE) $(STARVE)
tests_negative_ranks_memory_LDADD = $(CORE_LIBS)
tests_negative_ranks_memory_LDFLAGS = $(STARVE_WRAPS)
tests_negative_ranks_memory_graphs_SOURCES = tests/negative/ranks_memory_graphs.c $(MISUSE) $(STARVE)
tests_negative_ranks_memory_graphs_LDADD = $(CORE_LIBS)
tests_negative_ranks_memory_graphs_LDFLAGS = $(STARVE_WRAPS)
tests_negative_ranks_system_SOURCES = tests/negative/ranks_system.c $(MISUSE)
tests_negative_ranks_system_LDADD = $(CORE_LIBS)
tests_negative_ranks_system_LDFLAGS = -Wl,--wrap=pthread_create,--wrap=mmap
check_PROGRAMS += tests/negative/ranks_lost
tests_negative_ranks_lost_SOURCES = tests/negative/ranks_lost.c $(MISUSE)
tests_negative_ranks_lost_LDADD = $(CORE_LIBS)
check_PROGRAMS += tests/negative/ranks_large
tests_negative_ranks_large_SOURCES = tests/negative/ranks_large.c $(MISUSE)
tests_negative_ranks_large_LDADD = $(CORE_LIBS)

if HAVE_CHECK
LEAK_TESTS += tests/negative/test_arguments tests/negative/test_accesses tests/negative/test_start tests/negative/test_state \
    tests/negative/test_failures tests/negative/test_laws tests/negative/test_sizes tests/negative/test_nested
tests_negative_test_arguments_SOURCES = tests/negative/test_arguments.c $(MISUSE)
tests_negative_test_arguments_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_accesses_SOURCES = tests/negative/test_accesses.c $(MISUSE)
tests_negative_test_accesses_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_start_SOURCES = tests/negative/test_start.c $(MISUSE)
tests_negative_test_start_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_state_SOURCES = tests/negative/test_state.c $(MISUSE)
tests_negative_test_state_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_failures_SOURCES = tests/negative/test_failures.c $(MISUSE)
tests_negative_test_failures_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_laws_SOURCES = tests/negative/test_laws.c $(MISUSE)
tests_negative_test_laws_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_nested_SOURCES = tests/negative/test_nested.c $(MISUSE)
tests_negative_test_nested_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_sizes_SOURCES = tests/negative/test_sizes.c $(MISUSE)
tests_negative_test_sizes_LDADD = $(DUITE_TEST_LIBS)
endif
