/* What scenes may not say of groups of faces and of panels, with its place. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MORE(text) "material: cotton", "material: cotton\n    " text

/* Three triangles with uv: left and right, and one in no group; then a mesh without uv. */
static const char fan[] = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv -1 0 1\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt -1 1\n"
                          "f 1/1 5/5 4/4\ng left\nf 1/1 4/4 3/3\ng right\nf 1/1 3/3 2/2\n";
static const char plain[] = "v 0 0 0\nv 1 0 0\nv 1 0 1\ng left\nf 1 3 2\n";

static void expect(const char *file, const struct scene_wrong *wrong, size_t n)
{
    char mesh[64];
    snprintf(mesh, sizeof mesh, "mesh: {file: %s}", file);
    char *scene =
        scene_changed(scene_right, "mesh: {grid: {width: 1, height: 2, nx: 4, ny: 3}}", mesh);
    char *pinned = scene_changed(scene, "    loads: [{vertices: [11], force: [0, 1, 0]}]\n", "");
    scene_write_file("fan.obj", fan, sizeof fan - 1);
    scene_write_file("plain.obj", plain, sizeof plain - 1);
    for (size_t i = 0; i < n; i++) {
        char *text = scene_changed(pinned, wrong[i].from, wrong[i].to);
        scene_expect_error(text, NULL, wrong[i].error);
        free(text);
    }
    free(pinned);
    free(scene);
}

#define EXPECT_OF(file, ...)                                                                       \
    do {                                                                                           \
        static const struct scene_wrong all[] = {__VA_ARGS__};                                     \
        expect(file, all, sizeof all / sizeof all[0]);                                             \
    } while (0)

UNIT_TEST(groups_that_are_not_there)
{
    EXPECT({"pins: [{vertices: [0, 3]}]", "pins: [{group: left}]",
            .error = ":7:20: the mesh of cloth 'sheet' has no groups; an OBJ file with lines "
                     "`g NAME` before faces, or a pattern, is expected"},
           {"pins: [{vertices: [0, 3]}]", "pins: [{group: left, vertices: [0]}]",
            .error = ":7:26: cloths[0].pins[0] has both group and vertices; one of vertices or "
                     "nearest or box or group is expected"},
           {MORE("panels: [{group: left, grain: 3}]"),
            .error = ":7:22: the mesh of cloth 'sheet' has no groups; an OBJ file with lines "
                     "`g NAME` before faces, or a pattern, is expected"});
    EXPECT_OF("fan.obj",
              {"pins: [{vertices: [0, 3]}]", "pins: [{group: lefd}]",
               .error = ":7:20: there is no group of faces 'lefd'; did you mean 'left'? Allowed: "
                        "left, right"},
              {"pins: [{vertices: [0, 3]}]", "masses: [{group: top, mass: 1}]",
               .error = ":7:22: there is no group of faces 'top'; allowed: left, right"},
              {MORE("regions: [{group: top, material: cotton}]"),
               .error = ":7:23: there is no group of faces 'top'; allowed: left, right"},
              {MORE("panels: [{group: top, grain: 1}]"),
               .error = ":7:22: there is no group of faces 'top'; allowed: left, right"});
}

UNIT_TEST(panels_that_cannot_be_made)
{
    EXPECT_OF(
        "fan.obj",
        {MORE("panels: [{grain: 1}]"),
         .error = ":7:14: cloths[0].panels[0].group is missing; a text is expected"},
        {MORE("panels: [{group: left}]"),
         .error = ":7:14: a panel has neither material nor grain; one of them, at least, is "
                  "expected"},
        {MORE("panels: [{group: left, grain: warp}]"),
         .error = ":7:35: cloths[0].panels[0].grain is warp; a finite number (degrees) is "
                  "expected"},
        {MORE("panels: [{group: left, grain: 1}, {group: right, grain: 1}, {group: left, "
              "material: cotton}]"),
         .error = ":7:73: group 'left' stands twice in panels; once is expected"},
        {MORE("panels: [{group: left, material: wool}]"),
         .error = ":7:38: there is no material 'wool'; allowed: cotton, rib_knit, silk, denim, "
                  "polycotton"},
        {MORE("panels: [{group: left, material: denim}]"),
         .error = ":7:38: material 'denim' of a panel has another model than 'cotton', that of the "
                  "cloth; the same is expected"});
    EXPECT_OF("plain.obj",
              {MORE("panels: [{group: left, grain: 0}]"),
               .error = ":7:35: the grain of a panel is measured from u, but the mesh of cloth "
                        "'sheet' has no uv; an OBJ file with vt, or a pattern, is expected"});
}

UNIT_TEST(more_panels_than_there_is_room_for)
{
    char panels[4000] = "panels: [{group: left, grain: 1}", expected[200];
    for (int i = 0; i < 64; i++)
        strcat(panels, ", {group: right, material: cotton}");
    strcat(panels, "]");
    snprintf(expected, sizeof expected,
             ":7:13: cloth 'sheet' has 65 panels and regions; at most 64 are possible");
    char text[4100];
    snprintf(text, sizeof text, "material: cotton\n    %s", panels);
    const struct scene_wrong wrong = {"material: cotton", text, .error = expected};
    expect("fan.obj", &wrong, 1);
}
