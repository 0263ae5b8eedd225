if HAVE_CHECK
ASAN_TESTS += tests/cloth/mesh/test_grid tests/cloth/mesh/test_disc tests/cloth/mesh/test_obj \
    tests/cloth/mesh/test_polygons tests/cloth/mesh/test_inline tests/cloth/mesh/test_edges tests/cloth/mesh/test_lattice \
    tests/cloth/mesh/test_elastic tests/cloth/mesh/test_blocks tests/cloth/mesh/test_shadow tests/cloth/mesh/test_real \
    tests/cloth/mesh/test_memory
tests_cloth_mesh_test_grid_SOURCES = tests/cloth/mesh/test_grid.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_disc_SOURCES = tests/cloth/mesh/test_disc.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_disc_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_mesh_test_obj_SOURCES = tests/cloth/mesh/test_obj.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_polygons_SOURCES = tests/cloth/mesh/test_polygons.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_inline_SOURCES = tests/cloth/mesh/test_inline.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_edges_SOURCES = tests/cloth/mesh/test_edges.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_lattice_SOURCES = tests/cloth/mesh/test_lattice.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_elastic_SOURCES = tests/cloth/mesh/test_elastic.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_blocks_SOURCES = tests/cloth/mesh/test_blocks.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_shadow_SOURCES = tests/cloth/mesh/test_shadow.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_shadow_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_mesh_test_real_SOURCES = tests/cloth/mesh/test_real.c tests/cloth/mesh/tools.h
tests_cloth_mesh_test_memory_SOURCES = tests/cloth/mesh/test_memory.c $(SCARCE) tests/cloth/mesh/tools.h
tests_cloth_mesh_test_memory_LDFLAGS = $(SCARCE_WRAP)
if HAVE_ASSIMP
ASAN_TESTS += tests/cloth/mesh/test_figure
tests_cloth_mesh_test_figure_SOURCES = tests/cloth/mesh/test_figure.c tests/support/skinned.c tests/support/skinned.h \
	tests/cloth/mesh/tools.h
tests_cloth_mesh_test_figure_LDADD = $(CLOTH_TEST_LIBS) -lm
endif
endif
EXTRA_DIST += tests/cloth/mesh/column.fbx
