noinst_LIBRARIES += libduite_cloth.a
libduite_cloth_a_SOURCES =
CLOTH_LIBS = libduite_cloth.a $(ASSIMP_LIBS) $(HDF5_LIBS) $(YAML_LIBS) $(ZMQ_LIBS) $(CORE_LIBS)

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

include cloth/app/module.mk

scenesdir = $(pkgdatadir)/scenes
dist_scenes_DATA =
include cloth/scenes/module.mk
