if HAVE_CHECK
SCENE_TESTS = tests/cloth/scene/test_sentences tests/cloth/scene/test_errors tests/cloth/scene/test_rules tests/cloth/scene/test_values \
    tests/cloth/scene/test_contact_values tests/cloth/scene/test_sets tests/cloth/scene/test_bodies tests/cloth/scene/test_pattern_mesh \
    tests/cloth/scene/test_seams tests/cloth/scene/test_fabrics
ASAN_TESTS += $(SCENE_TESTS)
SCENE_FILE = tests/cloth/scene/scene_file.c tests/cloth/scene/scene_file.h
tests_cloth_scene_test_sentences_SOURCES = tests/cloth/scene/test_sentences.c cloth/app/run/phases_same.c $(SCENE_FILE)
tests_cloth_scene_test_errors_SOURCES = tests/cloth/scene/test_errors.c $(SCENE_FILE)
tests_cloth_scene_test_rules_SOURCES = tests/cloth/scene/test_rules.c $(SCENE_FILE)
tests_cloth_scene_test_values_SOURCES = tests/cloth/scene/test_values.c $(SCENE_FILE)
tests_cloth_scene_test_fabrics_SOURCES = tests/cloth/scene/test_fabrics.c $(SCENE_FILE)
tests_cloth_scene_test_contact_values_SOURCES = tests/cloth/scene/test_contact_values.c $(SCENE_FILE)
tests_cloth_scene_test_sets_SOURCES = tests/cloth/scene/test_sets.c $(SCENE_FILE)
tests_cloth_scene_test_bodies_SOURCES = tests/cloth/scene/test_bodies.c $(SCENE_FILE)
tests_cloth_scene_test_pattern_mesh_SOURCES = tests/cloth/scene/test_pattern_mesh.c $(SCENE_FILE)
tests_cloth_scene_test_seams_SOURCES = tests/cloth/scene/test_seams.c $(SCENE_FILE)
# Writes the sentences of errors and warnings again where they are said in other words, of the same places.
golden-sentences: tests/cloth/scene/test_sentences
	DUITE_SENTENCES=sentences.new srcdir='$(srcdir)' tests/cloth/scene/test_sentences
	mv sentences.new '$(srcdir)/tests/cloth/scene/sentences.txt'
endif
EXTRA_DIST += tests/cloth/scene/sentences.txt
