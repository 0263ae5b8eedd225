if HAVE_CHECK
ASAN_TESTS += tests/cloth/live/test_message tests/cloth/live/test_scene
tests_cloth_live_test_scene_SOURCES = tests/cloth/live/test_scene.c tests/cloth/contact/bodies.h
tests_cloth_live_test_scene_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
if HAVE_ZMQ
ASAN_TESTS += tests/cloth/live/test_publish
tests_cloth_live_test_publish_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS) $(ZMQ_LIBS)
endif
endif
