/* ParaView from 5.12 on reads the series; the XDMF file is for what reads no VTKHDF. Both name a
 * frame by its place beside them, so that a folder can be moved. */
#include "cloth/output/hdf5/hdf5.h"

#include <stdlib.h>

const struct output_index_form output_index_forms[OUTPUT_INDEXES] = {
    [OUTPUT_SERIES] = {"cloth.vtkhdf.series",
                       "{\n\"file-series-version\": \"1.0\",\n\"files\": [\n", "{\"name\": \"",
                       "]\n}\n"},
    [OUTPUT_XMF] = {"cloth.xmf",
                    "<?xml version=\"1.0\"?>\n<!-- frames of duite-cloth -->\n<Xdmf "
                    "Version=\"2.0\">\n<Domain>\n<Grid Name=\"frames\" GridType=\"Collection\" "
                    "CollectionType=\"Temporal\">\n",
                    "<Grid Name=\"cloth\">", "</Grid>\n</Domain>\n</Xdmf>\n"},
};

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

static void put_field(FILE *text, const char *frame, const struct output_grid *grid, int field,
                      int bytes)
{
    const struct output_field_form *form = output_fields + field;
    char array[64];
    snprintf(array, sizeof array, "/VTKHDF/%s/%s", form->is_of_cells ? "CellData" : "PointData",
             form->name);
    fprintf(text, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">", form->name,
            form->width > 1 ? "Vector" : "Scalar", form->is_of_cells ? "Cell" : "Node");
    put_item(text, frame, array, output_grid_rows(grid, field), form->width,
             form->is_whole ? "Int" : "Float", form->is_whole ? 4 : bytes);
    fputs("</Attribute>\n", text);
}

static void put_grid(FILE *text, const struct output_hdf5_setup *setup,
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
            put_field(text, frame, grid, i, bytes);
    fputs("</Grid>\n", text);
}

char *output_index_entry(int index, const struct output_hdf5_setup *setup,
                         const struct output_grid *grid, const char *frame, double time)
{
    char *entry = NULL;
    size_t n;
    FILE *text = open_memstream(&entry, &n);
    if (text && index == OUTPUT_XMF)
        put_grid(text, setup, grid, frame, time);
    else if (text)
        fprintf(text, "{\"name\": \"%s\", \"time\": %.17g}", frame, time);
    if (text && fclose(text) == 0)
        return entry;
    free(entry);
    return NULL;
}
