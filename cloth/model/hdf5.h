#ifndef CLOTH_MODEL_HDF5_H
#define CLOTH_MODEL_HDF5_H

#include <stdbool.h>
#include <stdint.h>

/* Fields of scientific frames beside the positions. */
struct model_hdf5 {
    bool velocity, block, rank; /* of vertices, */
    bool contact_force;         /* as these; */
    bool strain, stress;        /* of triangles */
    bool is_double;             /* numbers on the disk; else float */
    uint32_t every;             /* of all frames each k-th; 0: there are no such frames */
    uint32_t level;             /* of gzip; 0: none */
};

static inline bool model_hdf5_takes(const struct model_hdf5 *hdf5, uint64_t frame)
{
    return hdf5->every && frame % hdf5->every == 0;
}

#endif
