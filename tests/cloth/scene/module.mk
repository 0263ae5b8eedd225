if HAVE_CHECK
ASAN_TESTS += tests/cloth/scene/test_idle tests/cloth/scene/test_rules tests/cloth/scene/test_values \
    tests/cloth/scene/test_contact_values tests/cloth/scene/test_sets tests/cloth/scene/test_errors tests/cloth/scene/test_cloth_errors \
    tests/cloth/scene/test_force_errors tests/cloth/scene/test_obstacle_errors tests/cloth/scene/test_pattern_mesh \
    tests/cloth/scene/test_group_errors tests/cloth/scene/test_edge_errors tests/cloth/scene/test_seams
tests_cloth_scene_test_idle_SOURCES = tests/cloth/scene/test_idle.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_rules_SOURCES = tests/cloth/scene/test_rules.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_values_SOURCES = tests/cloth/scene/test_values.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_contact_values_SOURCES = tests/cloth/scene/test_contact_values.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_sets_SOURCES = tests/cloth/scene/test_sets.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_errors_SOURCES = tests/cloth/scene/test_errors.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_cloth_errors_SOURCES = tests/cloth/scene/test_cloth_errors.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_force_errors_SOURCES = tests/cloth/scene/test_force_errors.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_obstacle_errors_SOURCES = tests/cloth/scene/test_obstacle_errors.c tests/cloth/scene/scene_file.c \
	tests/cloth/scene/scene_file.h
tests_cloth_scene_test_pattern_mesh_SOURCES = tests/cloth/scene/test_pattern_mesh.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_group_errors_SOURCES = tests/cloth/scene/test_group_errors.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_edge_errors_SOURCES = tests/cloth/scene/test_edge_errors.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_seams_SOURCES = tests/cloth/scene/test_seams.c tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
endif
