libduite_cloth_a_SOURCES += cloth/model/cloth.h cloth/model/contact.c cloth/model/contact.h cloth/model/model.c cloth/model/model.h
