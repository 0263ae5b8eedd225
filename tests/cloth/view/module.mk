ASAN_SH += tests/cloth/view/test_view.sh tests/cloth/view/test_window_live.sh
PLAIN_SH += tests/cloth/view/test_window.sh

if HAVE_VIEW
check_PROGRAMS += tests/cloth/view/alike tests/cloth/view/hues
tests_cloth_view_hues_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_cloth_view_hues_LDADD = $(VIEW_LIBS) $(PNG_LIBS)
tests_cloth_view_alike_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_cloth_view_alike_LDADD = $(PNG_LIBS)
if HAVE_CHECK
ASAN_TESTS += tests/cloth/view/test_coarse tests/cloth/view/test_colour tests/cloth/view/test_player tests/cloth/view/test_camera \
    tests/cloth/view/test_picture
tests_cloth_view_test_colour_LDADD = tests/support/libunit.a $(VIEW_LIBS) $(CHECK_LIBS)
tests_cloth_view_test_camera_LDADD = tests/support/libunit.a $(VIEW_LIBS) $(CHECK_LIBS)
tests_cloth_view_test_coarse_CPPFLAGS = $(AM_CPPFLAGS) $(EPOXY_CFLAGS)
tests_cloth_view_test_coarse_LDADD = tests/support/libunit.a $(VIEW_LIBS) $(CHECK_LIBS)
tests_cloth_view_test_picture_CPPFLAGS = $(AM_CPPFLAGS) $(PNG_CFLAGS)
tests_cloth_view_test_picture_LDADD = tests/support/libunit.a $(VIEW_LIBS) $(CHECK_LIBS) $(PNG_LIBS)
tests_cloth_view_test_player_LDADD = tests/support/libunit.a $(VIEW_LIBS) $(CHECK_LIBS)
endif
endif
