if HAVE_CHECK
check_LIBRARIES += tests/cloth/output/libsample.a
tests_cloth_output_libsample_a_SOURCES = tests/cloth/output/sample.c tests/cloth/output/sample.h

ASAN_TESTS += tests/cloth/output/test_frames tests/cloth/output/test_report tests/cloth/output/test_replace \
    tests/cloth/output/test_crash tests/cloth/output/test_market tests/cloth/output/test_checkpoint tests/cloth/output/test_colours \
    tests/cloth/output/test_settle
tests_cloth_output_test_checkpoint_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
tests_cloth_output_test_colours_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
tests_cloth_output_test_market_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
tests_cloth_output_test_frames_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
tests_cloth_output_test_replace_SOURCES = tests/cloth/output/test_replace.c tests/cloth/contact/bodies.h
tests_cloth_output_test_replace_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
tests_cloth_output_test_report_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
tests_cloth_output_test_crash_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS)
if HAVE_HDF5
ASAN_TESTS += tests/cloth/output/test_hdf5
tests_cloth_output_test_hdf5_LDADD = tests/cloth/output/libsample.a $(CLOTH_TEST_LIBS) $(HDF5_LIBS)
endif
endif
