/* A frame as HDF5 in the VTKHDF layout, made in memory by HDF5's core driver. The layout is that of
 * version 1.0, of which a grid without time steps is the same in 2.0: readers of either take it.
 * Times of creation are left out, so that equal frames are equal files. */
#include "config.h"

#include "cloth/output/hdf5/hdf5.h"

#ifdef HAVE_HDF5
#include <hdf5.h>

/* An array on its way into a file. */
struct array {
    const char *name;
    const void *data;
    hid_t from, to;      /* its numbers in memory; on the disk */
    hsize_t rows, width; /* width 0: it has one dimension */
};

/* A file under way. HDF5 fails, and says no more, where it is given what could not be made: so
 * failures are noted, and nothing is asked before the next call. */
struct image {
    hid_t file, top;
    unsigned level;
    bool bad;
};

/* It starts HDF5, too: on a thread that may call MPI, as a library that was built with it does. */
const char *output_hdf5_lacks(uint32_t level)
{
    H5open();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return level && H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0
               ? "the HDF5 of this duite cannot compress by gzip; compression: 0 is expected"
               : NULL;
}

static void hdf5_image_note(struct image *image, herr_t code)
{
    image->bad = image->bad || code < 0;
}

/* How an array is kept. Rows are compressed about a MiB at a time, bytes of equal weight side by
 * side. */
static hid_t properties(struct image *image, const struct array *array, size_t size)
{
    const hid_t is = H5Pcreate(H5P_DATASET_CREATE);
    hdf5_image_note(image, H5Pset_obj_track_times(is, false));
    if (!image->level || !array->rows || !size)
        return is;
    const hsize_t width = array->width ? array->width : 1, most = 1048576 / (size * width);
    const hsize_t chunk[2] = {array->rows < most ? array->rows : most, width};
    hdf5_image_note(image, H5Pset_chunk(is, array->width ? 2 : 1, chunk));
    hdf5_image_note(image, H5Pset_shuffle(is));
    hdf5_image_note(image, H5Pset_deflate(is, image->level));
    return is;
}

static void hdf5_image_put(struct image *image, hid_t group, const struct array *array)
{
    const hsize_t size[2] = {array->rows, array->width};
    const hid_t space = H5Screate_simple(array->width ? 2 : 1, size, NULL);
    const hid_t is = properties(image, array, H5Tget_size(array->to));
    const hid_t set =
        H5Dcreate2(group, array->name, array->to, space, H5P_DEFAULT, is, H5P_DEFAULT);
    if (array->rows)
        hdf5_image_note(image,
                        H5Dwrite(set, array->from, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->data));
    hdf5_image_note(image, H5Dclose(set));
    H5Pclose(is);
    H5Sclose(space);
}

static hid_t hdf5_image_group(struct image *image, hid_t within, const char *name)
{
    const hid_t is = H5Pcreate(H5P_GROUP_CREATE);
    hdf5_image_note(image, H5Pset_obj_track_times(is, false));
    const hid_t made = H5Gcreate2(within, name, H5P_DEFAULT, is, H5P_DEFAULT);
    H5Pclose(is);
    return made;
}

static void leave(struct image *image, hid_t group)
{
    hdf5_image_note(image, H5Gclose(group));
}

static void attribute(struct image *image, const char *name, hid_t from, hid_t to, hid_t space,
                      const void *data)
{
    const hid_t made = H5Acreate2(image->top, name, to, space, H5P_DEFAULT, H5P_DEFAULT);
    hdf5_image_note(image, H5Awrite(made, from, data));
    H5Aclose(made);
}

static void put_attributes(struct image *image)
{
    static const char TYPE[] = "UnstructuredGrid";
    static const int LAYOUT[2] = {1, 0};
    const hsize_t two = 2;
    const hid_t pair = H5Screate_simple(1, &two, NULL), one = H5Screate(H5S_SCALAR);
    const hid_t text = H5Tcopy(H5T_C_S1);
    hdf5_image_note(image, H5Tset_size(text, sizeof TYPE - 1));
    hdf5_image_note(image, H5Tset_strpad(text, H5T_STR_NULLPAD));
    attribute(image, "Version", H5T_NATIVE_INT, H5T_STD_I64LE, pair, LAYOUT);
    attribute(image, "Type", text, text, one, TYPE);
    H5Tclose(text);
    H5Sclose(pair);
    H5Sclose(one);
}

static void put_longs(struct image *image, hid_t where, const char *name, const int64_t *data,
                      size_t n)
{
    const struct array array = {name, data, H5T_NATIVE_INT64, H5T_STD_I64LE, n, 0};
    hdf5_image_put(image, where, &array);
}

static void hdf5_image_put_grid(struct image *image, const struct output_grid *grid)
{
    const size_t n_cells = output_grid_cells(grid);
    const int64_t count[] = {grid->n_points, (int64_t)n_cells, (int64_t)grid->n_corners};
    const struct array kinds = {"Types", grid->kind, H5T_NATIVE_UCHAR, H5T_STD_U8LE, n_cells, 0};
    put_longs(image, image->top, "NumberOfPoints", count, 1);
    put_longs(image, image->top, "NumberOfCells", count + 1, 1);
    put_longs(image, image->top, "NumberOfConnectivityIds", count + 2, 1);
    put_longs(image, image->top, "Connectivity", grid->corners, grid->n_corners);
    put_longs(image, image->top, "Offsets", grid->start, n_cells + 1);
    hdf5_image_put(image, image->top, &kinds);
    if (grid->mixed)
        put_longs(image, image->file, "XdmfCells", grid->mixed, grid->n_mixed);
}

static void put_state(struct image *image, const struct output_hdf5_setup *setup,
                      const struct output_grid *grid, const struct output_state *state)
{
    const hid_t real = setup->is_double ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
    const struct array points = {"Points", state->position, H5T_NATIVE_DOUBLE,
                                 real,     grid->n_points,  3};
    const struct array time = {"TimeValue", &state->time, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, 1, 0};
    hdf5_image_put(image, image->top, &points);
    const hid_t of[2] = {hdf5_image_group(image, image->top, "PointData"),
                         hdf5_image_group(image, image->top, "CellData")};
    const hid_t field = hdf5_image_group(image, image->top, "FieldData");
    for (int i = 0; i < OUTPUT_FIELDS; i++) {
        const struct output_field_form *form = output_fields + i;
        const bool whole = form->is_whole;
        const struct array array = {form->name,
                                    whole ? (void *)state->number[i] : (void *)state->field[i],
                                    whole ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE,
                                    whole ? H5T_STD_I32LE : real,
                                    output_grid_rows(grid, i),
                                    form->width > 1 ? form->width : 0};
        if (setup->wants[i])
            hdf5_image_put(image, of[form->is_of_cells], &array);
    }
    hdf5_image_put(image, field, &time);
    leave(image, field);
    leave(image, of[0]);
    leave(image, of[1]);
}

static hid_t create(struct image *image, size_t increment)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS), is = H5Pcreate(H5P_FILE_CREATE);
    hdf5_image_note(image, H5Pset_fapl_core(access, increment, false));
    hdf5_image_note(image, H5Pset_obj_track_times(is, false));
    /* without the driver in memory there would be a file of that name on the disk */
    const hid_t file = image->bad ? -1 : H5Fcreate("frame", H5F_ACC_TRUNC, is, access);
    H5Pclose(access);
    H5Pclose(is);
    return file;
}

/* Takes the bytes of the file. */
static int hdf5_image_take(struct image *image, struct cloth_list *bytes, struct cloth_error *error)
{
    hdf5_image_note(image, H5Fflush(image->file, H5F_SCOPE_LOCAL));
    const ssize_t size = image->bad ? -1 : H5Fget_file_image(image->file, NULL, 0);
    if (size < 0)
        return cloth_fail(error, CLOTH_E_LIBRARY, "HDF5 could not make a frame");
    bytes->n = 0;
    void *to = cloth_list_add(bytes, 1, (size_t)size, error);
    if (!to)
        return CLOTH_E_MEMORY;
    return H5Fget_file_image(image->file, to, (size_t)size) == size
               ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_LIBRARY, "HDF5 could not copy a frame");
}

int output_image(const struct output_hdf5_setup *setup, const struct output_grid *grid,
                 const struct output_state *state, struct cloth_list *bytes,
                 struct cloth_error *error)
{
    struct image image = {.file = -1, .top = -1, .level = setup->level};
    image.file = create(&image, (size_t)output_hdf5_bytes(setup));
    image.top = hdf5_image_group(&image, image.file, "VTKHDF");
    put_attributes(&image);
    hdf5_image_put_grid(&image, grid);
    put_state(&image, setup, grid, state);
    leave(&image, image.top);
    const int code = hdf5_image_take(&image, bytes, error);
    H5Fclose(image.file);
    return code;
}

#else

const char *output_hdf5_lacks(uint32_t level)
{
    (void)level;
    return "this duite was built without HDF5; ./bootstrap --full installs it, then build again";
}

int output_image(const struct output_hdf5_setup *setup, const struct output_grid *grid,
                 const struct output_state *state, struct cloth_list *bytes,
                 struct cloth_error *error)
{
    (void)setup, (void)grid, (void)state, (void)bytes;
    return cloth_fail(error, CLOTH_E_LIBRARY, "this duite was built without HDF5");
}

#endif
