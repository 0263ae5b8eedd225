dist_check_SCRIPTS += tests/cloth/view/test_view.sh
TESTS += tests/cloth/view/test_view.sh

if HAVE_VIEW
if HAVE_CHECK
check_PROGRAMS += tests/cloth/view/test_camera tests/cloth/view/test_picture
tests_cloth_view_test_camera_SOURCES = tests/cloth/view/test_camera.c
tests_cloth_view_test_camera_LDADD = libduite_view.la $(CLOTH_TEST_LIBS)
tests_cloth_view_test_picture_SOURCES = tests/cloth/view/test_picture.c
tests_cloth_view_test_picture_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_cloth_view_test_picture_LDADD = libduite_view.la $(CLOTH_TEST_LIBS) $(PNG_LIBS)
TESTS += tests/cloth/view/test_camera tests/cloth/view/test_picture
endif
endif
