/* What a run warns of before it begins: vertices that nothing uses, pins and loads on them, and a
 * cloth that starts inside an obstacle. Each names its place. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <string.h>

static void warns(const struct flow *flow, size_t i, const char *text)
{
    const char *warning = flow_warning(flow, i);
    ck_assert_msg(warning && strncmp(warning, text, strlen(text)) == 0, "%s",
                  warning ? warning : "no warning");
}

UNIT_TEST(vertices_without_faces)
{
    static const double vertices[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 5, 5}};
    static const uint32_t triangle[] = {0, 1, 2};
    struct setup setup;
    for (uint32_t n = 0; n < 2; n++) {
        struct cloth_error error = {0};
        struct flow *flow = NULL;
        setup_sheet(&setup, 2);
        setup_free(&setup);
        setup.material.shear = 0; /* of grids alone */
        setup.cloth.mesh_place = (char[]){"a.yaml:4:9"};
        ck_assert_int_eq(
            mesh_inline(&setup.cloth.mesh, 4, vertices[0], 0, NULL, n, triangle, &error), 0);
        ck_assert_int_eq(flow_prepare(&flow, &setup.model, 1, &error),
                         n ? CLOTH_OK : CLOTH_E_INPUT);
        if (n) {
            ck_assert_uint_eq(flow_vertices(flow), 4);
            warns(flow, 0,
                  "a.yaml:4:9: vertices that no face, edge or joint uses: 1, the first is vertex 4 "
                  "of cloth 'test' (vertices count from 1); ");
            ck_assert_ptr_null(flow_warning(flow, 1));
        } else {
            ck_assert_msg(
                strstr(error.text,
                       "a.yaml:4:9: nothing to simulate: no face, edge or joint uses a vertex") !=
                    NULL,
                "%s", error.text);
        }
        flow_free(flow);
        setup_free(&setup);
    }
}

UNIT_TEST(pins_and_loads_that_move_nothing)
{
    static const double vertices[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 5, 5}, {6, 6, 6}};
    static const uint32_t triangle[] = {0, 1, 2};
    struct setup setup;
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    setup_sheet(&setup, 2);
    setup_free(&setup);
    setup.material.shear = 0; /* of grids alone */
    ck_assert_int_eq(mesh_inline(&setup.cloth.mesh, 5, vertices[0], 0, NULL, 1, triangle, &error),
                     0);
    setup_pin(&setup, 4, (const uint32_t[]){0, 4, 4, 3});
    setup.pin.pick.place = (char[]){"a.yaml:5:9"};
    setup_load(&setup, 3, 0, 1, 0);
    setup.load.pick.place = (char[]){"a.yaml:6:9"};
    ck_assert_int_eq(flow_prepare(&flow, &setup.model, 1, &error), 0);
    warns(flow, 0, "vertices that no face, edge or joint uses: 2, the first is vertex 4 ");
    warns(
        flow, 1,
        "a.yaml:5:9: pinned vertices that no face, edge or joint uses: 2, the first is vertex 5 ");
    warns(flow, 2,
          "a.yaml:6:9: loads on vertices that no face, edge or joint uses: 1, the first is vertex "
          "4 ");
    ck_assert_ptr_null(flow_warning(flow, 3));
    flow_free(flow);
    setup_free(&setup);
}

/* The deepest vertex that no pin holds. */
UNIT_TEST(a_start_inside_an_obstacle)
{
    static const struct phys_key keys[] = {{.translate = {0, 9, 0}, .rotate = {1, 0, 0, 0}}};
    struct contact_shape shapes[] = {{.value = {0, 0, 0, 0, 1, 0}},
                                     {.kind = 1, .value = {0, 0, 0, 0.6}}};
    struct setup setup;
    for (int i = 0; i < 4; i++) {
        struct cloth_error error = {0};
        struct flow *flow = NULL;
        setup_sheet(&setup, 3);
        setup.cloth.place = (char[]){"a.yaml:4:9"};
        setup.model.obstacles = shapes;
        setup.model.n_obstacles = i ? 2 : 1; /* 0: it lies on the plane */
        setup.model.keys = (struct phys_key *)keys;
        shapes[1].n = i == 1; /* 1: the ball is elsewhere at time 0 */
        if (i == 3)
            setup_pin(&setup, 1, (const uint32_t[]){4});
        ck_assert_int_eq(flow_prepare(&flow, &setup.model, 1, &error), CLOTH_OK);
        if (i < 2)
            ck_assert_ptr_null(flow_warning(flow, 0));
        else
            warns(flow, 0,
                  i == 2 ? "a.yaml:4:9: cloth 'test' starts inside obstacles[1], a sphere: vertex "
                           "5 is 0.6 m deep in it (vertices count from 1)"
                         : "a.yaml:4:9: cloth 'test' starts inside obstacles[1], a sphere: vertex "
                           "2 is 0.1 m deep in it (vertices count from 1)");
        flow_free(flow);
        setup_free(&setup);
    }
}

/* Two triangles of a square, the second one turned round. */
UNIT_LOOP(windings_that_disagree, 0, 2)
{
    static const double place[] = {0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1};
    static const uint32_t triangles[2][6] = {{0, 2, 1, 0, 3, 2}, {0, 2, 1, 0, 2, 3}};
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    struct setup setup;
    setup_sheet(&setup, 3);
    mesh_free(&setup.cloth.mesh);
    ck_assert_int_eq(mesh_inline(&setup.cloth.mesh, 4, place, 0, NULL, 2, triangles[_i], &error),
                     0);
    setup.cloth.mesh_place = (char[]){"a.yaml:4:9"};
    setup.material.shear = 0;
    ck_assert_int_eq(flow_prepare(&flow, &setup.model, 1, &error), CLOTH_OK);
    if (_i)
        warns(flow, 0,
              "a.yaml:4:9: cloth 'test' has 1 edges whose two triangles are wound against each "
              "other, the first is between vertices 1 and 3 (counted from 1): which side is its "
              "outside differs there; turn the faces of one side round");
    else
        ck_assert_ptr_null(flow_warning(flow, 0));
    flow_free(flow);
    setup_free(&setup);
}
