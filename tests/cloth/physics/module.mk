if HAVE_CHECK
ASAN_TESTS += tests/cloth/physics/test_bending tests/cloth/physics/test_curve tests/cloth/physics/test_particle \
    tests/cloth/physics/test_spring tests/cloth/physics/test_stage tests/cloth/physics/test_tiny tests/cloth/physics/test_triangle \
    tests/cloth/physics/test_triangle_forms tests/cloth/physics/test_energy tests/cloth/physics/test_limit
tests_cloth_physics_test_bending_SOURCES = tests/cloth/physics/test_bending.c tests/cloth/physics/elements.c tests/cloth/physics/elements.h
tests_cloth_physics_test_bending_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_curve_SOURCES = tests/cloth/physics/test_curve.c
tests_cloth_physics_test_curve_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_particle_SOURCES = tests/cloth/physics/test_particle.c
tests_cloth_physics_test_particle_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_spring_SOURCES = tests/cloth/physics/test_spring.c
tests_cloth_physics_test_spring_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_stage_SOURCES = tests/cloth/physics/test_stage.c
tests_cloth_physics_test_stage_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_tiny_SOURCES = tests/cloth/physics/test_tiny.c
tests_cloth_physics_test_tiny_LDADD = $(CLOTH_TEST_LIBS)
PHYSICS_TEST_TRIANGLES = tests/cloth/physics/triangle_sheet.h tests/cloth/physics/elements.c tests/cloth/physics/elements.h
tests_cloth_physics_test_triangle_SOURCES = tests/cloth/physics/test_triangle.c $(PHYSICS_TEST_TRIANGLES)
tests_cloth_physics_test_triangle_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_triangle_forms_SOURCES = tests/cloth/physics/test_triangle_forms.c $(PHYSICS_TEST_TRIANGLES)
tests_cloth_physics_test_triangle_forms_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_energy_SOURCES = tests/cloth/physics/test_energy.c
tests_cloth_physics_test_energy_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_physics_test_limit_SOURCES = tests/cloth/physics/test_limit.c
tests_cloth_physics_test_limit_LDADD = $(CLOTH_TEST_LIBS)
endif
