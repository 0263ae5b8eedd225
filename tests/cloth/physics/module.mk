if HAVE_CHECK
check_PROGRAMS += tests/cloth/physics/test_bending
tests_cloth_physics_test_bending_SOURCES = tests/cloth/physics/test_bending.c tests/cloth/physics/elements.c tests/cloth/physics/elements.h
tests_cloth_physics_test_bending_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_bending
check_PROGRAMS += tests/cloth/physics/test_particle
tests_cloth_physics_test_particle_SOURCES = tests/cloth/physics/test_particle.c
tests_cloth_physics_test_particle_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_particle
check_PROGRAMS += tests/cloth/physics/test_spring
tests_cloth_physics_test_spring_SOURCES = tests/cloth/physics/test_spring.c
tests_cloth_physics_test_spring_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_spring
check_PROGRAMS += tests/cloth/physics/test_stage
tests_cloth_physics_test_stage_SOURCES = tests/cloth/physics/test_stage.c
tests_cloth_physics_test_stage_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_stage
check_PROGRAMS += tests/cloth/physics/test_tiny
tests_cloth_physics_test_tiny_SOURCES = tests/cloth/physics/test_tiny.c
tests_cloth_physics_test_tiny_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_tiny
check_PROGRAMS += tests/cloth/physics/test_triangle
tests_cloth_physics_test_triangle_SOURCES = tests/cloth/physics/test_triangle.c tests/cloth/physics/elements.c tests/cloth/physics/elements.h
tests_cloth_physics_test_triangle_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/physics/test_triangle
endif
