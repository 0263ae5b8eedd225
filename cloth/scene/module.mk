libduite_cloth_a_SOURCES += \
	cloth/scene/scene.h \
	cloth/scene/scene.c \
	cloth/scene/pattern.h cloth/scene/pattern/reader.h \
	cloth/scene/pattern/panels.c cloth/scene/pattern/pattern.c cloth/scene/pattern/values.c \
	cloth/scene/yaml/tree.h cloth/scene/yaml/edit.h \
	cloth/scene/yaml/tree.c \
	cloth/scene/yaml/load.c cloth/scene/yaml/include.c \
	cloth/scene/yaml/scalar.c \
	cloth/scene/yaml/edit.c cloth/scene/yaml/sets.c \
	cloth/scene/schema/rules.h \
	cloth/scene/schema/rules.c \
	cloth/scene/schema/rules_cloth.c \
	cloth/scene/schema/rules_joints.c \
	cloth/scene/schema/rules_material.c \
	cloth/scene/schema/rules_obstacle.c \
	cloth/scene/schema/rules_run.c \
	cloth/scene/schema/rules_vertices.c \
	cloth/scene/schema/needs.h \
	cloth/scene/schema/page.c \
	cloth/scene/schema/tables.h \
	cloth/scene/schema/store.c \
	cloth/scene/schema/words.c \
	cloth/scene/schema/fabrics.c cloth/scene/schema/instruments.c \
	cloth/scene/schema/faults.c \
	cloth/scene/schema/check.h \
	cloth/scene/schema/check.c \
	cloth/scene/build/build.h \
	cloth/scene/build/build.c \
	cloth/scene/build/names.c \
	cloth/scene/build/pick.c \
	cloth/scene/build/world.c \
	cloth/scene/build/mesh.c \
	cloth/scene/build/cloth.c \
	cloth/scene/build/contact.c \
	cloth/scene/build/crossed.c \
	cloth/scene/build/girth.c \
	cloth/scene/build/fold.c \
	cloth/scene/build/band.c \
	cloth/scene/build/frames.c \
	cloth/scene/build/needs.c \
	cloth/scene/build/unusual.c \
	cloth/scene/build/joint.c \
	cloth/scene/build/load.c \
	cloth/scene/build/mannequin.c \
	cloth/scene/build/region.c \
	cloth/scene/build/settings.c \
	cloth/scene/build/seams.c \
	cloth/scene/build/seams_file.c \
	cloth/scene/build/sides.c \
	cloth/scene/build/start.c \
	cloth/scene/build/motion.c \
	cloth/scene/build/obstacle.c \
	cloth/scene/build/pattern.c \
	cloth/scene/build/pleats.c \
	cloth/scene/build/pieces.c cloth/scene/build/pin.c \
	cloth/scene/build/report.c cloth/scene/build/weights.c
nodist_libduite_cloth_a_SOURCES = cloth/scene/schema/prose.c
EXTRA_DIST += cloth/scene/schema/opening.md cloth/scene/schema/prose.md docs/scene.md
CLEANFILES += cloth/scene/schema/prose.c

# The program prints the page of all keys, so it has the prose: a string for each line.
cloth/scene/schema/prose.c: cloth/scene/schema/prose.md
	$(AM_V_GEN)$(MKDIR_P) cloth/scene/schema && { echo '/* Made of prose.md. */' && echo '/* clang-format off */' && \
	    echo '#include "cloth/scene/schema/rules.h"' && echo 'const char *const scene_prose[] = {' && \
	    sed 's/[\\"]/\\&/g; s/.*/"&",/' $(srcdir)/cloth/scene/schema/prose.md && echo '0};'; } > $@.new && mv $@.new $@

# docs/scene.md is made from the tables of keys and from prose; tests/whole/test_options.sh compares.
scene-page: duite-cloth$(EXEEXT)
	{ cat $(srcdir)/cloth/scene/schema/opening.md && ./duite-cloth$(EXEEXT) --keys=markdown; } > scene-page.new
	mv scene-page.new $(srcdir)/docs/scene.md
