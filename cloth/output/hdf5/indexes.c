/* ParaView from 5.12 on reads the series; the XDMF file is for what reads no VTKHDF. Both name a
 * frame by its place beside them, so that a folder can be moved. */
#include "cloth/output/hdf5/hdf5.h"

#include "cloth/output/files/cut.h"
#include "cloth/output/files/files.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *const output_field_names[OUTPUT_FIELDS] = {
    [OUTPUT_VELOCITY] = "velocity",   [OUTPUT_BLOCK] = "block",   [OUTPUT_RANK] = "rank",
    [OUTPUT_FORCE] = "contact_force", [OUTPUT_STRAIN] = "strain", [OUTPUT_STRESS] = "stress"};

static const struct output_index_form INDEX[OUTPUT_INDEXES] = {
    [OUTPUT_SERIES] = {"cloth.vtkhdf.series",
                       "{\n\"file-series-version\": \"1.0\",\n\"files\": [\n", "{\"name\": \"",
                       "]\n}\n"},
    [OUTPUT_XMF] = {"cloth.xmf",
                    "<?xml version=\"1.0\"?>\n<!-- frames of duite-cloth -->\n<Xdmf "
                    "Version=\"2.0\">\n<Domain>\n<Grid Name=\"frames\" GridType=\"Collection\" "
                    "CollectionType=\"Temporal\">\n",
                    "<Grid Name=\"cloth\">", "</Grid>\n</Domain>\n</Xdmf>\n"},
};

/* ---- Entries ---- */

/* An array of the frame's file. */
static void put_item(FILE *text, const char *frame, const char *array, size_t rows, unsigned width,
                     const char *type, int bytes)
{
    fprintf(text, "<DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%d\" Dimensions=\"%zu",
            type, bytes, rows);
    if (width > 1)
        fprintf(text, " %u", width);
    fprintf(text, "\">%s:%s</DataItem>", frame, array);
}

static void put_cells(FILE *text, const char *frame, const struct output_grid *grid)
{
    const bool edges = grid->n_triangles == 0;
    fprintf(text, "<Topology TopologyType=\"%s\"%s NumberOfElements=\"%u\">",
            grid->mixed ? "Mixed"
            : edges     ? "Polyline"
                        : "Triangle",
            edges ? " NodesPerElement=\"2\"" : "", output_grid_cells(grid));
    if (grid->mixed)
        put_item(text, frame, "/XdmfCells", grid->n_mixed, 1, "Int", 8);
    else
        put_item(text, frame, "/VTKHDF/Connectivity", grid->n_corners, 1, "Int", 8);
    fputs("</Topology>\n", text);
}

static void put_field(FILE *text, const char *frame, const struct output_grid *grid,
                      enum output_field field, int bytes)
{
    const bool cells = output_field_is_of_cells(field), whole = output_field_is_whole(field);
    const unsigned width = output_field_width(field);
    char array[64];
    snprintf(array, sizeof array, "/VTKHDF/%s/%s", cells ? "CellData" : "PointData",
             output_field_names[field]);
    fprintf(text, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">",
            output_field_names[field], width > 1 ? "Vector" : "Scalar", cells ? "Cell" : "Node");
    put_item(text, frame, array, cells ? output_grid_cells(grid) : grid->n_points, width,
             whole ? "Int" : "Float", whole ? 4 : bytes);
    fputs("</Attribute>\n", text);
}

static void indexes_put_grid(FILE *text, const struct output_hdf5_setup *setup,
                             const struct output_grid *grid, const char *frame, double time)
{
    const int bytes = setup->is_double ? 8 : 4;
    fprintf(text, "<Grid Name=\"cloth\">\n<Time Value=\"%.17g\"/>\n", time);
    put_cells(text, frame, grid);
    fputs("<Geometry GeometryType=\"XYZ\">", text);
    put_item(text, frame, "/VTKHDF/Points", grid->n_points, 3, "Float", bytes);
    fputs("</Geometry>\n", text);
    for (int i = 0; i < OUTPUT_FIELDS; i++)
        if (setup->wants[i])
            put_field(text, frame, grid, (enum output_field)i, bytes);
    fputs("</Grid>\n", text);
}

int output_indexes_add(struct output_indexes *indexes, const struct output_hdf5_setup *setup,
                       const struct output_grid *grid, const char *name, double time,
                       struct cloth_error *error)
{
    char *entry = NULL;
    size_t n = 0;
    FILE *text = open_memstream(&entry, &n);
    if (text)
        indexes_put_grid(text, setup, grid, name, time);
    int code = text && fclose(text) == 0
                   ? output_index_add(indexes->of + OUTPUT_XMF, entry, n, error)
                   : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the index of frames");
    free(entry);
    char line[128];
    const int size = snprintf(line, sizeof line, "{\"name\": \"%s\", \"time\": %.17g}", name, time);
    const int series = output_index_add(indexes->of + OUTPUT_SERIES, line, (size_t)size, error);
    return code ? code : series;
}

/* ---- What an earlier run left ---- */

void output_hdf5_name(char name[OUTPUT_HDF5_NAME], uint64_t frame)
{
    snprintf(name, OUTPUT_HDF5_NAME, OUTPUT_HDF5_FRAME "%06ju.vtkhdf", (uintmax_t)frame);
}

/* Whether a file of the folder hdf5 has a name that frames get, and whose: UINT64_MAX, nobody's,
 * of one that was under way. */
static bool is_frame(const char *name, uint64_t *frame)
{
    static const char BEGIN[] = "frame-";
    if (strncmp(name, BEGIN, sizeof BEGIN - 1) != 0)
        return false;
    name += sizeof BEGIN - 1;
    const size_t digits = strspn(name, "0123456789");
    const bool half = strcmp(name + digits, ".vtkhdf.part") == 0;
    *frame = half ? UINT64_MAX : strtoull(name, NULL, 10);
    return digits >= 6 && (half || strcmp(name + digits, ".vtkhdf") == 0);
}

/* Whether it is a file of an index that nobody was to see. */
static bool is_hidden_index(const char *name)
{
    for (int i = 0; i < OUTPUT_INDEXES; i++) {
        const size_t n = strlen(INDEX[i].name);
        if (strncmp(name, INDEX[i].name, n) == 0 && (strcmp(name + n, OUTPUT_INDEX_HIDDEN) == 0 ||
                                                     strcmp(name + n, OUTPUT_INDEX_SPARE) == 0))
            return true;
    }
    return false;
}

/* Removes frames from a number on, and those under way; with them the hidden indexes, or not.
 * *stay: whether there are frames before. */
static int remove_frames(const char *folder, uint64_t from, bool hidden, bool *stay,
                         struct cloth_error *error)
{
    char *frames = output_path(folder, "hdf5", "");
    DIR *all = frames ? opendir(frames) : NULL;
    int code = frames ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a path");
    *stay = false;
    for (struct dirent *entry = NULL; all && !code && (entry = readdir(all));) {
        uint64_t frame;
        const bool is = is_frame(entry->d_name, &frame), stays = is && frame < from;
        const bool goes = is ? !stays : hidden && is_hidden_index(entry->d_name);
        char *path = goes ? output_path(frames, entry->d_name, "") : NULL;
        if (path && unlink(path) != 0)
            code = output_refuse(error, "replace", path);
        free(path);
        *stay = *stay || stays;
    }
    if (all)
        closedir(all);
    free(frames);
    return code;
}

/* One that is there is ours; if it has to be, it is. */
static int check_index(const char *path, const struct output_index_form *form, bool has_to,
                       struct cloth_error *error)
{
    if (access(path, F_OK) != 0)
        return has_to ? cloth_fail(error, CLOTH_E_INPUT, "%s is gone: %s", path, OUTPUT_CHANGED)
                      : CLOTH_OK;
    return output_index_is_ours(path, form->begin)
               ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_INPUT,
                            "%s is in the way, and is no index of frames of an earlier run; give "
                            "another folder, or move the file away",
                            path);
}

/* All are looked at before one is removed. */
static int check_indexes(const char *folder, bool have_to, bool go, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (int i = 0; i < 2 * OUTPUT_INDEXES && !code; i++) {
        const struct output_index_form *form = INDEX + i % OUTPUT_INDEXES;
        char *path = output_path(folder, form->name, "");
        if (!path)
            return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of an index");
        if (i < OUTPUT_INDEXES)
            code = check_index(path, form, have_to, error);
        else if (go && unlink(path) != 0 && errno != ENOENT)
            code = output_refuse(error, "replace", path);
        free(path);
    }
    return code;
}

/* The indexes go first, so that none names what is not there. */
static int remove_all(const char *folder, struct cloth_error *error)
{
    bool stay;
    char *frames = output_path(folder, "hdf5", "");
    int code = frames ? check_indexes(folder, false, true, error)
                      : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a path");
    code = code ? code : remove_frames(folder, 0, true, &stay, error);
    if (!code)
        rmdir(frames); /* unless it has other files, too */
    free(frames);
    return code;
}

/* What is left of an earlier run that this one goes on with: frames, their indexes. */
static int remove_hidden(const char *folder, struct cloth_error *error)
{
    bool stay;
    const int code = remove_frames(folder, UINT64_MAX, true, &stay, error);
    return code ? code : check_indexes(folder, stay, false, error);
}

int output_indexes_open(struct output_indexes *indexes, const char *folder,
                        const uint64_t *n_frames, struct cloth_error *error)
{
    bool stay;
    char *frames = output_path(folder, "hdf5", "");
    for (int i = 0; i < OUTPUT_INDEXES; i++)
        indexes->of[i] = OUTPUT_INDEX_NONE;
    int code = n_frames ? remove_hidden(folder, error) : remove_all(folder, error);
    if (!code)
        code = frames ? output_make_folder(frames, error)
                      : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a path");
    for (int i = 0; i < OUTPUT_INDEXES && !code; i++)
        code = output_index_open(indexes->of + i, folder, INDEX + i, n_frames, error);
    if (!code && n_frames)
        code = remove_frames(folder, *n_frames, false, &stay, error);
    free(frames);
    return code;
}

int output_indexes_close(struct output_indexes *indexes, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (int i = 0; i < OUTPUT_INDEXES; i++) {
        const int failed = output_index_close(indexes->of + i, error);
        code = code ? code : failed;
    }
    return code;
}

/* What is no index of ours stays: nobody asked for it to go. */
int output_hdf5_forget(const char *folder, const uint64_t *n_frames, struct cloth_error *error)
{
    struct output_indexes indexes;
    bool ours = true;
    for (int i = 0; i < OUTPUT_INDEXES; i++) {
        char *path = output_path(folder, INDEX[i].name, "");
        ours = ours && path && output_index_is_ours(path, INDEX[i].begin);
        free(path);
    }
    if (!ours || !n_frames)
        return ours ? remove_all(folder, error) : CLOTH_OK;
    const int code = output_indexes_open(&indexes, folder, n_frames, error);
    const int closed = output_indexes_close(&indexes, error);
    return code ? code : closed;
}
