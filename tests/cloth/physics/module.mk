if HAVE_CHECK
ASAN_TESTS += tests/cloth/physics/test_air tests/cloth/physics/test_bending tests/cloth/physics/test_curve tests/cloth/physics/test_particle \
    tests/cloth/physics/test_spring tests/cloth/physics/test_tiny tests/cloth/physics/test_triangle \
    tests/cloth/physics/test_limit
PHYSICS_TEST_ELEMENTS = tests/cloth/physics/elements.c tests/cloth/physics/elements.h
tests_cloth_physics_test_spring_SOURCES = tests/cloth/physics/test_spring.c $(PHYSICS_TEST_ELEMENTS)
tests_cloth_physics_test_triangle_SOURCES = tests/cloth/physics/test_triangle.c $(PHYSICS_TEST_ELEMENTS)
endif
