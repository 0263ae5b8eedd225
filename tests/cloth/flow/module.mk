if HAVE_CHECK
FLOW_TEST_MODELS = tests/cloth/flow/models.c tests/cloth/flow/models.h
LEAK_TESTS += tests/cloth/flow/test_failures tests/cloth/flow/test_run tests/cloth/flow/test_memory
TSAN_TESTS += tests/cloth/flow/test_grid tests/cloth/flow/test_skins \
    tests/cloth/flow/test_sliders tests/cloth/flow/test_ties \
    tests/cloth/flow/test_ties_runs tests/cloth/flow/test_levels
ASAN_TESTS += tests/cloth/flow/test_motion tests/cloth/flow/test_halving tests/cloth/flow/test_limits tests/cloth/flow/test_strain_limit \
    tests/cloth/flow/test_checked tests/cloth/flow/test_stops tests/cloth/flow/test_fields
PLAIN_TESTS += tests/cloth/flow/test_solvers tests/cloth/flow/test_obstacles tests/cloth/flow/test_singular \
    tests/cloth/flow/test_integrators tests/cloth/flow/test_chain tests/cloth/flow/test_newton
tests_cloth_flow_test_failures_SOURCES = tests/cloth/flow/test_failures.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_memory_SOURCES = tests/cloth/flow/test_memory.c $(SCARCE) $(FLOW_TEST_MODELS)
tests_cloth_flow_test_memory_LDFLAGS = $(SCARCE_WRAP) -Wl,--wrap=flow_memory_take,--wrap=flow_source_gather,--wrap=duite_new
check_PROGRAMS += tests/cloth/flow/test_late
tests_cloth_flow_test_late_SOURCES = tests/cloth/flow/test_late.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_late_LDFLAGS = $(AM_LDFLAGS) -Wl,--wrap=flow_halo_make
tests_cloth_flow_test_motion_SOURCES = tests/cloth/flow/test_motion.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_run_SOURCES = tests/cloth/flow/test_run.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_solvers_SOURCES = tests/cloth/flow/test_solvers.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_halving_SOURCES = tests/cloth/flow/test_halving.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_obstacles_SOURCES = tests/cloth/contact/bodies.h tests/cloth/flow/test_obstacles.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_skins_SOURCES = tests/cloth/flow/test_skins.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_sliders_SOURCES = tests/cloth/flow/test_sliders.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_singular_SOURCES = tests/cloth/flow/test_singular.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_integrators_SOURCES = tests/cloth/flow/test_integrators.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_limits_SOURCES = tests/cloth/flow/test_limits.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_strain_limit_SOURCES = tests/cloth/flow/test_strain_limit.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_chain_SOURCES = tests/cloth/flow/test_chain.c $(FLOW_TEST_MODELS)
tests_cloth_flow_test_newton_SOURCES = tests/cloth/flow/test_newton.c $(FLOW_TEST_MODELS)
CHECKED_RUNS = tests/cloth/flow/checked_runs.h tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h $(FLOW_TEST_MODELS)
tests_cloth_flow_test_checked_SOURCES = tests/cloth/flow/test_checked.c $(CHECKED_RUNS)
tests_cloth_flow_test_stops_SOURCES = tests/cloth/flow/test_stops.c $(CHECKED_RUNS)
tests_cloth_flow_test_checked_LDFLAGS = $(AM_LDFLAGS) -Wl,--wrap=check_call
FLOW_TEST_SESSION = tests/cloth/flow/session.c tests/cloth/flow/session.h $(FLOW_TEST_MODELS)
tests_cloth_flow_test_ties_SOURCES = tests/cloth/flow/test_ties.c tests/cloth/flow/random_ties.h $(FLOW_TEST_MODELS)
tests_cloth_flow_test_levels_SOURCES = tests/cloth/flow/test_levels.c $(FLOW_TEST_SESSION)
tests_cloth_flow_test_ties_runs_SOURCES = tests/cloth/flow/test_ties_runs.c $(FLOW_TEST_SESSION)
tests_cloth_flow_test_fields_SOURCES = tests/cloth/flow/test_fields.c tests/cloth/flow/kinds.c tests/cloth/flow/kinds.h $(FLOW_TEST_SESSION)
endif
ASAN_SH += tests/cloth/flow/test_kernels.sh tests/cloth/flow/test_ranks.sh
LONG_SH += tests/cloth/flow/test_ranks_long.sh tests/cloth/flow/test_checked_long.sh
EXTRA_DIST += tests/cloth/flow/kernels_wrong.c
