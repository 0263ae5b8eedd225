if HAVE_CHECK
check_PROGRAMS += tests/cloth/contact/test_body tests/cloth/contact/test_body_refused tests/cloth/contact/test_meet tests/cloth/contact/test_shape tests/cloth/contact/test_solid
tests_cloth_contact_test_body_SOURCES = tests/cloth/contact/test_body.c tests/cloth/contact/bodies.h
tests_cloth_contact_test_body_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_contact_test_body_refused_SOURCES = tests/cloth/contact/test_body_refused.c tests/cloth/contact/bodies.h
tests_cloth_contact_test_body_refused_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_contact_test_meet_SOURCES = tests/cloth/contact/test_meet.c
tests_cloth_contact_test_meet_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_contact_test_shape_SOURCES = tests/cloth/contact/test_shape.c
tests_cloth_contact_test_shape_LDADD = $(CLOTH_TEST_LIBS)
check_PROGRAMS += tests/cloth/contact/test_skin
tests_cloth_contact_test_skin_SOURCES = tests/cloth/contact/test_skin.c
tests_cloth_contact_test_skin_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/contact/test_skin
TESTS += tests/cloth/contact/test_body tests/cloth/contact/test_body_refused tests/cloth/contact/test_meet tests/cloth/contact/test_shape tests/cloth/contact/test_solid
tests_cloth_contact_test_solid_SOURCES = tests/cloth/contact/test_solid.c
tests_cloth_contact_test_solid_LDADD = $(CLOTH_TEST_LIBS)
check_PROGRAMS += tests/cloth/contact/test_body_skin
tests_cloth_contact_test_body_skin_SOURCES = tests/cloth/contact/test_body_skin.c tests/cloth/contact/bodies.h
tests_cloth_contact_test_body_skin_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/contact/test_body_skin
endif
