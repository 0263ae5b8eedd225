if HAVE_CHECK
CONTACT_TEST_RANDOM = tests/cloth/contact/shapes.h tests/support/random.h
ASAN_TESTS += tests/cloth/contact/test_body tests/cloth/contact/test_body_skin \
    tests/cloth/contact/test_certificate tests/cloth/contact/test_image tests/cloth/contact/test_meet tests/cloth/contact/test_pair \
    tests/cloth/contact/test_push tests/cloth/contact/test_row tests/cloth/contact/test_shape tests/cloth/contact/test_skin tests/cloth/contact/test_solid \
    tests/cloth/contact/test_body_frames
LONG_SH += tests/cloth/contact/test_certificate_long.sh
tests_cloth_contact_test_body_SOURCES = tests/cloth/contact/test_body.c tests/cloth/contact/bodies.h tests/cloth/contact/distances.h \
	tests/support/random.h
tests_cloth_contact_test_body_skin_SOURCES = tests/cloth/contact/test_body_skin.c tests/cloth/contact/bodies.h tests/support/random.h
tests_cloth_contact_test_certificate_SOURCES = tests/cloth/contact/test_certificate.c tests/cloth/contact/pairs.h tests/support/random.h
tests_cloth_contact_test_image_SOURCES = tests/cloth/contact/test_image.c tests/cloth/contact/images.h tests/cloth/contact/bodies.h
tests_cloth_contact_test_pair_SOURCES = tests/cloth/contact/test_pair.c tests/cloth/contact/pairs.h tests/support/random.h
tests_cloth_contact_test_push_SOURCES = tests/cloth/contact/test_push.c tests/cloth/contact/pairs.h tests/support/random.h
tests_cloth_contact_test_shape_SOURCES = tests/cloth/contact/test_shape.c $(CONTACT_TEST_RANDOM)
tests_cloth_contact_test_skin_SOURCES = tests/cloth/contact/test_skin.c tests/cloth/contact/skin_sheet.h tests/cloth/contact/distances.h \
	tests/support/random.h
tests_cloth_contact_test_solid_SOURCES = tests/cloth/contact/test_solid.c tests/cloth/contact/solids.h $(CONTACT_TEST_RANDOM)
if HAVE_GMP
ASAN_TESTS += tests/cloth/contact/test_certificate_exact
tests_cloth_contact_test_certificate_exact_SOURCES = tests/cloth/contact/test_certificate_exact.c tests/cloth/contact/pairs.h tests/support/random.h
tests_cloth_contact_test_certificate_exact_LDADD = $(CLOTH_TEST_LIBS) $(GMP_LIBS)
endif
tests_cloth_contact_test_body_frames_SOURCES = tests/cloth/contact/test_body_frames.c tests/cloth/contact/bodies.h
endif
