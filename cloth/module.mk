noinst_LIBRARIES += libduite_cloth.a
libduite_cloth_a_SOURCES =
CLOTH_LIBS = libduite_cloth.a $(HDF5_LIBS) $(YAML_LIBS) $(ZMQ_LIBS) $(CORE_LIBS)

include cloth/base/module.mk
include cloth/mesh/module.mk
include cloth/physics/module.mk
include cloth/contact/module.mk
include cloth/verify/module.mk
include cloth/untangle/module.mk
include cloth/garment/module.mk
include cloth/mannequin/module.mk
include cloth/solve/module.mk
include cloth/model/module.mk
include cloth/element/module.mk
include cloth/flow/module.mk
include cloth/scene/module.mk
include cloth/output/module.mk
include cloth/live/module.mk
include cloth/view/module.mk

bin_PROGRAMS += duite-cloth
dist_man_MANS += cloth/duite-cloth.1
duite_cloth_SOURCES = \
	cloth/duite-cloth.c \
	cloth/drape.h cloth/environment.h cloth/intersections.h cloth/keeper.h cloth/restart.h cloth/outputs.h cloth/outputs_colours.h \
	cloth/outputs_hdf5.h cloth/phases.h cloth/phases_check.h cloth/progress.h cloth/room.h cloth/simulate.h cloth/simulate_run.h \
	cloth/start.h \
	cloth/drape.c cloth/environment.c cloth/intersections.c cloth/intersections_model.c cloth/intersections_parts.h cloth/intersections_parts.c \
	cloth/intersections_soup.h cloth/intersections_soup.c cloth/keeper.c cloth/outputs.c cloth/outputs_colours.c cloth/outputs_hdf5.c \
	cloth/phases.c cloth/phases_check.c cloth/phases_motions.c cloth/progress.c cloth/restart.c cloth/room.c cloth/simulate.c \
	cloth/simulate_begin.c cloth/stops.c cloth/start.c cloth/start_welds.c cloth/start_welds.h \
	cloth/shipped.h cloth/shipped.c \
	cloth/outputs_setup.h cloth/outputs_setup.c \
	cloth/summary.h cloth/summary.c cloth/summary_numbers.h cloth/summary_numbers.c cloth/summary_print.c cloth/summary_seams.h \
	cloth/summary_seams.c cloth/summary_time.h cloth/summary_time.c
duite_cloth_CPPFLAGS = $(AM_CPPFLAGS) -DSHIPPED_SCENES='"$(scenesdir)"'
duite_cloth_LDADD = libduite_tools.a $(CLOTH_LIBS)

bin_PROGRAMS += duite-garment
dist_man_MANS += cloth/duite-garment.1
duite_garment_SOURCES = cloth/duite-garment.c
duite_garment_LDADD = $(CLOTH_LIBS)

bin_PROGRAMS += duite-mannequin
dist_man_MANS += cloth/duite-mannequin.1
duite_mannequin_SOURCES = cloth/duite-mannequin.c
duite_mannequin_LDADD = $(CLOTH_LIBS)

scenesdir = $(pkgdatadir)/scenes
dist_scenes_DATA =
include cloth/scenes/module.mk
EXTRA_DIST += cloth/demo.sh

demo: all
	@srcdir='$(srcdir)' MPIRUN='$(MPIRUN)' VIEW_MISSING='$(VIEW_MISSING)' $(SHELL) $(srcdir)/cloth/demo.sh
