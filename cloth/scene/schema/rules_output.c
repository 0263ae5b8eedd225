/* Keys for the files of a run. */
#include "cloth/scene/schema/tables.h"

const struct model_word scene_hdf5_fields[] = {
    {"velocity", (int)offsetof(struct model_hdf5, velocity)},
    {"block", (int)offsetof(struct model_hdf5, block)},
    {"rank", (int)offsetof(struct model_hdf5, rank)},
    {"strain", (int)offsetof(struct model_hdf5, strain)},
    {"stress", (int)offsetof(struct model_hdf5, stress)},
    {"contact_force", (int)offsetof(struct model_hdf5, contact_force)},
    {0}};

/* clang-format off */
static const struct scene_rule field = {.type = SCENE_CHOICE, .words = scene_hdf5_fields};
static const struct scene_rule hdf5_keys[] = {
    {"fields", SCENE_LIST, .filled = true, .fallback = "[velocity, block, rank, strain]",
     .inside = &field, .about = "of vertices velocity, block, rank, contact_force; of triangles "
                                "strain: the largest principal one, stress"},
    {"precision", SCENE_CHOICE, .fallback = "single", INTO(struct model_hdf5, is_double),
     WORDS({"single", false}, {"double", true}), .about = "of numbers in the files"},
    {"every", SCENE_INTEGER, .fallback = "1", .min = 1, INTO(struct model_hdf5, every),
     .about = "of the frames each so many-th, from the first on"},
    {"compression", SCENE_INTEGER, .fallback = "0", .max = 9, INTO(struct model_hdf5, level),
     .about = "level of gzip; 0: none"},
    {0}};
const struct scene_rule scene_output_keys[] = {
    {"hdf5", SCENE_MAP, .inside = hdf5_keys, INTO(struct model, hdf5),
     PLACE(struct model, hdf5_place),
     .about = "frames for ParaView and for analysis, beside the others; else there are none"},
    {0}};
/* clang-format on */
