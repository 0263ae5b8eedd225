if HAVE_CHECK
FLOW_TEST_MODELS = tests/cloth/flow/models.c tests/cloth/flow/models.h
check_PROGRAMS += tests/cloth/flow/test_failures tests/cloth/flow/test_motion tests/cloth/flow/test_run
tests_cloth_flow_test_failures_SOURCES = tests/cloth/flow/test_failures.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_failures_LDADD = $(CLOTH_TEST_LIBS)
check_PROGRAMS += tests/cloth/flow/test_memory
tests_cloth_flow_test_memory_SOURCES = tests/cloth/flow/test_memory.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_memory_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_flow_test_memory_LDFLAGS = $(AM_LDFLAGS) -Wl,--wrap=malloc -Wl,--wrap=calloc \
	-Wl,--wrap=realloc -Wl,--wrap=aligned_alloc -Wl,--wrap=flow_memory_take -Wl,--wrap=flow_source_gather
TESTS += tests/cloth/flow/test_memory
check_PROGRAMS += tests/cloth/flow/test_late
tests_cloth_flow_test_late_SOURCES = tests/cloth/flow/test_late.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_late_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_flow_test_late_LDFLAGS = $(AM_LDFLAGS) -Wl,--wrap=flow_halo_make
tests_cloth_flow_test_motion_SOURCES = tests/cloth/flow/test_motion.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_motion_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_flow_test_run_SOURCES = tests/cloth/flow/test_run.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_run_LDADD = $(CLOTH_TEST_LIBS)
check_PROGRAMS += tests/cloth/flow/test_solvers
tests_cloth_flow_test_solvers_SOURCES = tests/cloth/flow/test_solvers.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_solvers_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_solvers
check_PROGRAMS += tests/cloth/flow/test_grid tests/cloth/flow/test_halving
tests_cloth_flow_test_grid_SOURCES = tests/cloth/flow/test_grid.c
tests_cloth_flow_test_grid_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_flow_test_halving_SOURCES = tests/cloth/flow/test_halving.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_halving_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_grid tests/cloth/flow/test_halving
check_PROGRAMS += tests/cloth/flow/test_contact
tests_cloth_flow_test_contact_SOURCES = tests/cloth/flow/test_contact.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_contact_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_contact
check_PROGRAMS += tests/cloth/flow/test_guides
tests_cloth_flow_test_guides_SOURCES = tests/cloth/flow/test_guides.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_guides_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_guides
check_PROGRAMS += tests/cloth/flow/test_singular
tests_cloth_flow_test_singular_SOURCES = tests/cloth/flow/test_singular.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_singular_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_singular
TESTS += tests/cloth/flow/test_failures tests/cloth/flow/test_motion tests/cloth/flow/test_run
check_PROGRAMS += tests/cloth/flow/test_integrators
tests_cloth_flow_test_integrators_SOURCES = tests/cloth/flow/test_integrators.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_integrators_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_integrators
check_PROGRAMS += tests/cloth/flow/test_limits
tests_cloth_flow_test_limits_SOURCES = tests/cloth/flow/test_limits.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_limits_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_limits
check_PROGRAMS += tests/cloth/flow/test_strain_limit
tests_cloth_flow_test_strain_limit_SOURCES = tests/cloth/flow/test_strain_limit.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_strain_limit_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_strain_limit
check_PROGRAMS += tests/cloth/flow/test_chain
tests_cloth_flow_test_chain_SOURCES = tests/cloth/flow/test_chain.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_chain_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_chain
check_PROGRAMS += tests/cloth/flow/test_newton
tests_cloth_flow_test_newton_SOURCES = tests/cloth/flow/test_newton.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_newton_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/flow/test_newton
check_PROGRAMS += tests/cloth/flow/test_checked
tests_cloth_flow_test_checked_SOURCES = tests/cloth/flow/test_checked.c $(FLOW_TEST_MODELS) \
	tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_flow_test_checked_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_flow_test_checked_LDFLAGS = $(AM_LDFLAGS) -Wl,--wrap=check_call
TESTS += tests/cloth/flow/test_checked
endif
dist_check_SCRIPTS += tests/cloth/flow/test_ranks.sh tests/cloth/flow/test_ranks_long.sh
TESTS += tests/cloth/flow/test_ranks.sh
LONG_TESTS += tests/cloth/flow/test_ranks_long.sh
dist_check_SCRIPTS += tests/cloth/flow/test_checked_long.sh
LONG_TESTS += tests/cloth/flow/test_checked_long.sh
