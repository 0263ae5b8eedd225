MISUSE = tests/negative/misuse.c tests/negative/misuse.h
REFUSED = $(MISUSE) tests/negative/refused.c tests/negative/refused.h
LEAK_SH += tests/negative/test_ranks.sh
ASAN_SH += tests/negative/test_lost.sh tests/negative/test_environment.sh
LONG_SH += tests/negative/test_lost_long.sh tests/negative/test_memory_long.sh
check_PROGRAMS += tests/negative/ranks
tests_negative_ranks_SOURCES = $(RANKS) tests/negative/ranks_blocking.c tests/negative/ranks_different.c tests/negative/ranks_failures.c \
    tests/negative/ranks_groups.c tests/negative/ranks_large.c tests/negative/ranks_lost.c
tests_negative_ranks_LDADD = $(CORE_LIBS)
# Refusals by the system, through wraps that also do without the pool of memory.
check_PROGRAMS += tests/negative/starved
tests_negative_starved_SOURCES = $(RANKS) tests/negative/starve.c tests/negative/starve.h tests/negative/ranks_memory.c \
    tests/negative/ranks_memory_graphs.c tests/negative/ranks_system.c
tests_negative_starved_LDADD = $(CORE_LIBS)
tests_negative_starved_LDFLAGS = -Wl,--wrap=malloc,--wrap=realloc,--wrap=aligned_alloc,--wrap=pthread_create,--wrap=mmap \
    -Wl,--wrap=base_pool_take_more,--wrap=base_pool_give_more

if HAVE_CHECK
LEAK_TESTS += tests/negative/test_arguments tests/negative/test_accesses tests/negative/test_start tests/negative/test_state \
    tests/negative/test_failures tests/negative/test_laws tests/negative/test_sizes tests/negative/test_nested
tests_negative_test_arguments_SOURCES = tests/negative/test_arguments.c $(REFUSED)
tests_negative_test_arguments_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_accesses_SOURCES = tests/negative/test_accesses.c $(REFUSED)
tests_negative_test_accesses_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_start_SOURCES = tests/negative/test_start.c $(REFUSED)
tests_negative_test_start_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_state_SOURCES = tests/negative/test_state.c $(MISUSE)
tests_negative_test_state_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_failures_SOURCES = tests/negative/test_failures.c $(REFUSED)
tests_negative_test_failures_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_laws_SOURCES = tests/negative/test_laws.c $(REFUSED)
tests_negative_test_laws_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_nested_SOURCES = tests/negative/test_nested.c $(MISUSE)
tests_negative_test_nested_LDADD = $(DUITE_TEST_LIBS)
tests_negative_test_sizes_SOURCES = tests/negative/test_sizes.c $(REFUSED)
tests_negative_test_sizes_LDADD = $(DUITE_TEST_LIBS)
endif
