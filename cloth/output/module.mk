libduite_cloth_a_SOURCES += \
	cloth/output/output.h \
	cloth/output/colours.h cloth/output/colours.c cloth/output/colours_read.c \
	cloth/output/checkpoint.c cloth/output/checkpoint.h \
	cloth/output/forces.c \
	cloth/output/frames.c \
	cloth/output/garment.c cloth/output/garment.h cloth/output/pattern.c \
	cloth/output/lock.c \
	cloth/output/hdf5.h cloth/output/hdf5/hdf5.h \
	cloth/output/hdf5/frames.c cloth/output/hdf5/grid.c cloth/output/hdf5/image.c \
	cloth/output/hdf5/entries.c cloth/output/hdf5/index.c \
	cloth/output/mannequin.c cloth/output/mannequin.h \
	cloth/output/probes.c \
	cloth/output/cache.c \
	cloth/output/report.c \
	cloth/output/room.c \
	cloth/output/settle.c cloth/output/settle.h \
	cloth/output/files/begin.c \
	cloth/output/files/files.c cloth/output/files/grow.c cloth/output/files/files.h \
	cloth/output/files/json.c cloth/output/files/json.h \
	cloth/output/files/market.c \
	cloth/output/files/obj.c \
	cloth/output/files/pc2.c cloth/output/files/pc2.h \
	cloth/output/files/records.c cloth/output/files/records.h \
	cloth/output/files/scene.c cloth/output/files/scene_read.c cloth/output/files/scene.h
