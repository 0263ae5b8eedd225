/* A mesh of the parts that a reader has found, in lists of its file's order. */
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/detail/obj.h"

#include <stdlib.h>

/* The names of the groups and of the materials. */
static int make_names(struct obj_parts *parts, struct mesh *mesh, struct cloth_error *error)
{
    int code = obj_naming_end(&parts->naming, mesh->n_faces, &mesh->group, &mesh->n_groups,
                              &mesh->group_run, &mesh->n_group_runs, error);
    code = code
               ? code
               : obj_naming_end(&parts->drawing, mesh->n_faces, &mesh->material, &mesh->n_materials,
                                &mesh->material_run, &mesh->n_material_runs, error);
    mesh->n_libraries = (uint32_t)parts->library.n;
    mesh->library = parts->library.items;
    parts->library = (struct cloth_list){0};
    return code;
}

/* The items of a list as an array of its own length; the list is empty then. */
static void *hand_over(struct cloth_list *list, size_t size, struct cloth_error *error)
{
    if (!cloth_list_add(list, size, 0, error)) /* a list without items may have no array */
        return NULL;
    void *items = realloc(list->items, (list->n ? list->n : 1) * size);
    items = items ? items : list->items;
    *list = (struct cloth_list){0};
    return items;
}

static void make_mesh(struct obj_parts *parts, const char *path, bool fans, struct mesh *mesh,
                      struct cloth_error *error)
{
    mesh->n_vertices = (uint32_t)parts->position.n;
    mesh->n_faces = (uint32_t)parts->face_start.n;
    mesh->n_lone_edges = (uint32_t)parts->edge.n;
    uint32_t *end = cloth_list_add(&parts->face_start, sizeof *end, 1, error);
    mesh->face_corner = cloth_alloc(parts->corner.n, sizeof *mesh->face_corner, error);
    if (!end || !mesh->face_corner)
        return;
    *end = (uint32_t)parts->corner.n;
    const uint32_t(*corner)[2] = parts->corner.items;
    for (size_t c = 0; c < parts->corner.n; c++)
        mesh->face_corner[c] = corner[c][0];
    mesh->position = hand_over(&parts->position, 3 * sizeof(double), error);
    mesh->face_start = hand_over(&parts->face_start, sizeof(uint32_t), error);
    mesh->lone_edge = hand_over(&parts->edge, 2 * sizeof(uint32_t), error);
    if (!mesh->lone_edge) /* the others have items */
        return;
    const struct mesh_source source = {path, parts->face_line.items, parts->edge_line.items, fans};
    if (!mesh_finish(mesh, &source, error) && !make_names(parts, mesh, error) && parts->uv.n &&
        parts->corner.n)
        obj_uv_put(mesh, parts->uv.items, parts->corner.items, error);
}

int obj_parts_make(struct obj_parts *parts, const char *path, bool fans, struct mesh *mesh,
                   struct cloth_error *error)
{
    make_mesh(parts, path, fans, mesh, error);
    if (error->code)
        mesh_free(mesh);
    return error->code;
}

void obj_parts_free(struct obj_parts *parts)
{
    free(parts->position.items);
    free(parts->uv.items);
    free(parts->corner.items);
    free(parts->face_start.items);
    free(parts->face_line.items);
    free(parts->edge.items);
    free(parts->edge_line.items);
    obj_naming_free(&parts->naming);
    obj_naming_free(&parts->drawing);
    for (size_t i = 0; i < parts->library.n; i++)
        free(((char **)parts->library.items)[i]);
    free(parts->library.items);
}
