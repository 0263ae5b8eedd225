if HAVE_CHECK
check_PROGRAMS += tests/cloth/physics/test_particle tests/cloth/physics/test_spring
tests_cloth_physics_test_particle_SOURCES = tests/cloth/physics/test_particle.c
tests_cloth_physics_test_particle_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_spring_SOURCES = tests/cloth/physics/test_spring.c
tests_cloth_physics_test_spring_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_particle tests/cloth/physics/test_spring
check_PROGRAMS += tests/cloth/physics/test_stage tests/cloth/physics/test_tiny
tests_cloth_physics_test_stage_SOURCES = tests/cloth/physics/test_stage.c
tests_cloth_physics_test_stage_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_tiny_SOURCES = tests/cloth/physics/test_tiny.c
tests_cloth_physics_test_tiny_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_stage tests/cloth/physics/test_tiny
endif
