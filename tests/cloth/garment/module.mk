GARMENT_PATTERNS = tests/cloth/garment/patterns/circle.json tests/cloth/garment/patterns/cushion.json tests/cloth/garment/patterns/cubic.json tests/cloth/garment/patterns/dart.json \
	tests/cloth/garment/patterns/fold.json tests/cloth/garment/patterns/gather.json tests/cloth/garment/patterns/hood.json \
	tests/cloth/garment/patterns/quadratic.json tests/cloth/garment/patterns/steep.json tests/cloth/garment/patterns/straight.json
EXTRA_DIST += $(GARMENT_PATTERNS)
if HAVE_CHECK
ASAN_TESTS += tests/cloth/garment/test_curves tests/cloth/garment/test_dxf tests/cloth/garment/test_girth tests/cloth/garment/test_own \
    tests/cloth/garment/test_delaunay
PLAIN_TESTS += tests/cloth/garment/test_mesh
tests_cloth_garment_test_curves_SOURCES = tests/cloth/garment/test_curves.c tests/cloth/garment/tools.h
tests_cloth_garment_test_curves_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_garment_test_dxf_SOURCES = tests/cloth/garment/test_dxf.c tests/cloth/garment/tools.h
tests_cloth_garment_test_dxf_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_garment_test_mesh_SOURCES = tests/cloth/garment/test_mesh.c tests/cloth/garment/tools.h
tests_cloth_garment_test_mesh_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_garment_test_girth_SOURCES = tests/cloth/garment/test_girth.c tests/cloth/garment/tools.h
tests_cloth_garment_test_girth_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_garment_test_own_SOURCES = tests/cloth/garment/test_own.c tests/cloth/garment/tools.h
tests_cloth_garment_test_own_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_garment_test_delaunay_LDADD = $(CLOTH_TEST_LIBS) -lm
endif
