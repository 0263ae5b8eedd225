/* What scenes may not say of edges: of joints that end on them, and of folds along them. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#define JOINT(to)                                                                                  \
    "schema: 1\n", "schema: 1\njoints: [{from: {vertex: 1}, to: {" to "}, stiffness: 1}]\n"

UNIT_TEST(joints_that_end_nowhere)
{
    EXPECT(
        {JOINT("edge: [4, 5]"),
         .error = ":2:34: the end of a joint on an edge has no at; a number from 0 to 1 is "
                  "expected, or a list of them, one for each edge"},
        {JOINT("edge: [4, 5], at: half"),
         .error = ":2:53: joints[0].to.at is half; a finite number or a list of them is "
                  "expected"},
        {JOINT("edge: [4, 5], at: 1.5"),
         .error = ":2:53: a joint ends at 1.5 of an edge; a number from 0, its first end, to "
                  "1, its second, is expected"},
        {JOINT("edges: [[4, 5]], at: [-0.1]"),
         .error = ":2:57: a joint ends at -0.1 of an edge; a number from 0, its first end, to "
                  "1, its second, is expected"},
        {JOINT("edges: [[4, 5]], at: [0, 1]"),
         .error = ":2:56: at has 2 numbers for 1 edges; as many are expected"},
        {JOINT("edges: [[4, 5], [5, 6]], at: 0"),
         .error = ":2:64: at has 1 numbers for 2 edges; as many are expected"},
        {JOINT("edges: [[4, 5], [5, 6]], at: [0, 1]"),
         .error = ":2:34: a joint has 1 vertices in from and 2 edges in to; as many are "
                  "expected"},
        {JOINT("edge: [4, 5, 6], at: 0"),
         .error = ":2:41: joints[0].to.edge is a list of 3; a list of 2 whole numbers is "
                  "expected"},
        {JOINT("edge: [4, 6], at: 0"),
         .error = ":2:41: vertices 4 and 6 are not the ends of an edge of cloth 'sheet'; such "
                  "two are expected"},
        {JOINT("edges: [[5, 4], [5, 5]], at: [0, 0]"),
         .error = ":2:51: vertices 5 and 5 are not the ends of an edge of cloth 'sheet'; such "
                  "two are expected"},
        {JOINT("edge: [4, 12], at: 0"),
         .error = ":2:41: vertices 4 and 12 are not the ends of an edge of cloth 'sheet'; such "
                  "two are expected"},
        {JOINT("vertex: 4, at: 0"),
         .error = ":2:50: at is given without an edge, which it is a place on; edge or edges is "
                  "expected"},
        {JOINT("edge: [4, 5], vertex: 3, at: 0"),
         .error = ":2:49: joints[0].to has both edge and vertex; one of vertex or vertices or "
                  "edge or edges is expected"},
        {"schema: 1\n",
         "schema: 1\njoints: [{from: {edge: [1, 2], at: 0}, to: {vertex: 3}, stiffness: 1}]\n",
         .error = ":2:18: edge is not a key of joints[0].from; allowed: cloth, vertex, vertices"},
        {"schema: 1\n", "schema: 1\nwelds: [{from: {vertex: 1}, to: {edge: [1, 2], at: 0}}]\n",
         .error = ":2:34: edge is not a key of welds[0].to; allowed: cloth, vertex, vertices"});
}

#define FOLD(text) "material: cotton", "material: cotton\n    folds: [{" text "}]"

UNIT_TEST(folds_that_cannot_be_made)
{
    EXPECT({FOLD("vertices: [4, 5]"),
            .error = ":7:13: cloths[0].folds[0].angle is missing; a finite number (degrees) is "
                     "expected"},
           {FOLD("angle: 90"),
            .error = ":7:13: cloths[0].folds[0] has no vertices or edge; one of them is expected"},
           {FOLD("vertices: [4, 5], angle: 180"),
            .error = ":7:39: a fold has an angle of 180 degrees; one above -180 and below 180 is "
                     "expected"},
           {FOLD("vertices: [4, 5], angle: -1e3"),
            .error = ":7:39: a fold has an angle of -1000 degrees; one above -180 and below 180 "
                     "is expected"},
           {FOLD("vertices: [4], angle: 90"),
            .error = ":7:24: a fold has one vertex; the vertices along it, two at least, are "
                     "expected"},
           {FOLD("vertices: [4, 12], angle: 90"),
            .error = ":7:28: vertex 12 is outside the mesh of cloth 'sheet', which has 12 "
                     "vertices; 0 to 11 are allowed"},
           {FOLD("vertices: [4, 5, 7], angle: 90"),
            .error = ":7:31: there is no edge between vertices 5 and 7 of cloth 'sheet', which a "
                     "fold has one after the other; such two are expected"},
           {FOLD("vertices: [4, 4], angle: 90"),
            .error = ":7:28: there is no edge between vertices 4 and 4 of cloth 'sheet', which a "
                     "fold has one after the other; such two are expected"},
           {FOLD("edge: {panel: front}, angle: 90"),
            .error = ":7:20: cloths[0].folds[0].edge.edge is missing; a whole number from 0 to "
                     "4294967295 is expected"},
           {FOLD("edge: {panel: front, edge: 1}, angle: 90"),
            .error = ":7:20: no seam of cloth 'sheet' has edge 1 of a panel 'front', so nothing "
                     "folds there; an edge that is sewn is expected"});
}
