libduite_cloth_la_SOURCES += cloth/model/cloth.h cloth/model/hdf5.h cloth/model/model.c cloth/model/model.h
