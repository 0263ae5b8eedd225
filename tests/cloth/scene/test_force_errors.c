/* Pins, loads, curves, motions, joints and welds that cannot be made: each has its own sentence, as
 * in test_errors.c. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

UNIT_TEST(pins_that_hold_to_nothing)
{
    EXPECT({"{vertices: [0, 3]}", "{vertices: [0, 3], to: lines}",
            .error = ":7:35: cloths[0].pins[0].to is lines; point or line or plane is expected"},
           {"{vertices: [0, 3]}", "{vertices: [0, 3], to: line}",
            .error = ":7:12: a pin to a line has no direction; a list of 3 numbers is expected"},
           {"{vertices: [0, 3]}", "{vertices: [0, 3], to: line, normal: [0, 1, 0]}",
            .error = ":7:12: a pin to a line has no direction; a list of 3 numbers is expected"},
           {"{vertices: [0, 3]}", "{vertices: [0, 3], direction: [0, 1, 0]}",
            .error =
                ":7:42: a pin to a point has a direction, which is that of a line; to: line is "
                "expected with it"},
           {"{vertices: [0, 3]}", "{vertices: [0, 3], to: plane, normal: [0, 0, 0]}",
            .error = ":7:50: the normal of a pin is zero; a direction is expected"},
           {"{vertices: [0, 3]}", "{vertices: [0, 3], to: plane, normal: [0, 1]}",
            .error = ":7:50: cloths[0].pins[0].normal is a list of 2; a list of 3 numbers is "
                     "expected"});
}

#define MOTION(text) "{vertices: [0, 3]}", "{vertices: [0, 3], motion: {" text "}}"

UNIT_TEST(loads_that_cannot_be_made)
{
    EXPECT({"vertices: [11]", "edges: [[0, 99]]",
            .error = ":8:26: vertex 99 is outside the mesh of cloth 'sheet', which has 12 "
                     "vertices; 0 to 11 are allowed"},
           {"vertices: [11]", "edges: [[3, 3]]",
            .error = ":8:26: an edge of a load joins vertex 3 to itself; two vertices are "
                     "expected"},
           {"vertices: [11]", "edges: [[0, 1]], radius: 1",
            .error = ":8:39: radius is given without nearest, the point that it is measured from; "
                     "both or neither are expected"},
           {"vertices: [11], ", "",
            .error = ":8:13: cloths[0].loads[0] has no vertices or nearest or box or group or "
                     "edges; one of "
                     "them is expected"});
}

#define CURVE(text) "force: [0, 1, 0]", "force: [0, 1, 0], curve: {" text "}"

UNIT_TEST(curves_that_cannot_be_made)
{
    EXPECT(
        {CURVE("keys: [[0, 1], [2, 1], [2, 0]]"),
         .error = ":8:80: the time of curve.keys[2] is 2, which does not come after 2, that of "
                  "the one before it; times in ascending order are expected"},
        {CURVE("keys: [[0, 1, 2]]"),
         .error = ":8:63: cloths[0].loads[0].curve.keys[0] is a list of 3; a list of 2 numbers "
                  "is expected"},
        {CURVE("keys: []"),
         .error =
             ":8:62: cloths[0].loads[0].curve.keys is an empty list; a non-empty list of lists is "
             "expected"},
        {CURVE("keys: [[0, .inf]]"),
         .error = ":8:67: cloths[0].loads[0].curve.keys[0][1] is .inf; a finite number is "
                  "expected"},
        {CURVE("sine: {frequency: 500}"),
         .error = ":8:74: curve.sine.frequency is 500, but steps of time.h = 0.001 s can "
                  "follow less than 500 turns a second; fewer, or shorter steps, are expected"},
        {CURVE("sine: {frequency: 0}"),
         .error = ":8:74: cloths[0].loads[0].curve.sine.frequency is 0; a finite number > 0 "
                  "(1/s) is expected"},
        {CURVE("sine: {frequency: 1, phas: 0}"),
         .error = ":8:77: phas is not a key of cloths[0].loads[0].curve.sine; did you mean "
                  "'phase'? Allowed: frequency, phase"},
        {CURVE("cosine: {frequency: 1}"),
         .error = ":8:56: cosine is not a key of cloths[0].loads[0].curve; did you mean "
                  "'sine'? Allowed: keys, sine"},
        {"gravity: [0, -9.81, 0]", "air: {course: {keys: [[0, 1]]}}",
         .error = ":2:7: course is no longer a key of air: its name is curve"},
        {"gravity: [0, -9.81, 0]", "air: {curve: {keys: [[0, 1], [0, 1]]}}",
         .error = ":2:31: the time of curve.keys[1] is 0, which does not come after 0, that of "
                  "the one before it; times in ascending order are expected"});
}

UNIT_TEST(motions_that_cannot_be_made)
{
    EXPECT(
        {MOTION("times: [0, 1, 1], translate: [[0, 0, 0], [1, 0, 0], [2, 0, 0]]"),
         .error = ":7:54: motion.times[2] is 1, which does not come after 1, the one before it; "
                  "times in "
                  "ascending order are expected"},
        {MOTION("times: [0, 1], translate: [[0, 0, 0]]"),
         .error = ":7:66: translate of a motion has 1 entries, but there are 2 times; as many are "
                  "expected"},
        {MOTION("times: [0, 1], rotate: [[1, 0, 0, 0], [0, 0, 0, 0]]"),
         .error = ":7:78: a rotation of a motion is zero; a quaternion [w, x, y, z] that is not is "
                  "expected"},
        {MOTION("times: [0, 1], rotate: [[1, 0, 0, 0], [0, 2, 0, 0]]"),
         .error = ":7:78: a rotation of a motion is half a turn from the one before, so that its "
                  "way is open; smaller ones are expected"},
        {MOTION("times: [0, 1], translate: [[0, 1, 0], [0, 0, 0]]"),
         .error = ":7:39: a motion does not begin where the vertices start; at time 0 no shift and "
                  "no rotation are expected"},
        {MOTION("times: [], translate: []"),
         .error = ":7:47: cloths[0].pins[0].motion.times is an empty list; a non-empty list of "
                  "numbers (s) is expected"});
}

#define JOINT(text) "\ntime: {h", "\njoints: [{" text "}]\ntime: {h"

UNIT_TEST(joints_that_cannot_be_made)
{
    EXPECT(
        {JOINT("from: {vertex: 1}, to: {vertex: 2}"),
         .error = ":12:10: joints[0].stiffness is missing; a finite number > 0 (N/m) is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 2}, stiffness: 0"),
         .error = ":12:58: joints[0].stiffness is 0; a finite number > 0 (N/m) is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 2}, stiffness: 1, damping: -1"),
         .error = ":12:70: joints[0].damping is -1; a finite number >= 0 (kg/s) is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 2}, stiffness: 1, length: -1"),
         .error = ":12:69: joints[0].length is -1; a finite number >= 0 (m) or start is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 2}, stiffness: 1, length: stop"),
         .error =
             ":12:69: joints[0].length is stop; a finite number >= 0 (m) or start is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 12}, stiffness: 1"),
         .error = ":12:43: vertex 12 is outside the mesh of cloth 'sheet', which has 12 vertices; "
                  "0 to 11 are allowed"},
        {JOINT("from: {vertices: [1, 2, 12]}, to: {vertices: [3, 4, 5]}, stiffness: 1"),
         .error = ":12:35: vertex 12 is outside the mesh of cloth 'sheet', which has 12 vertices; "
                  "0 to 11 are allowed"},
        {JOINT("from: {vertices: [1, 2]}, to: {vertex: 3}, stiffness: 1"),
         .error = ":12:41: a joint has 2 vertices in from and 1 in to; as many are expected"},
        {JOINT("from: {vertices: [1, 2], vertex: 1}, to: {vertex: 3}, stiffness: 1"),
         .error = ":12:36: joints[0].from has both vertices and vertex; one of vertex or vertices "
                  "is expected"},
        {JOINT("from: {}, to: {vertex: 3}, stiffness: 1"),
         .error = ":12:17: joints[0].from has no vertex or vertices; one of them is expected"},
        {JOINT("from: {vertex: 1, cloth: shet}, to: {vertex: 3}, stiffness: 1"),
         .error = ":12:36: there is no cloth 'shet'; did you mean 'sheet'? Allowed: sheet"},
        {JOINT("from: {vertex: 1}, to: {vertex: 3}, stiffness: 1, begin: -1"),
         .error = ":12:68: joints[0].begin is -1; a finite number >= 0 (s) is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 3}, stiffness: 1, end: 0"),
         .error = ":12:66: joints[0].end is 0; a finite number > 0 (s) or never is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 3}, stiffness: 1, begin: 0.2, end: 0.2"),
         .error = ":12:78: a joint ends at 0.2 s; a time after its begin, 0.2 s, is expected"},
        {JOINT("from: {vertex: 1}, to: {vertex: 3}, stiffness: 1, until: 1"),
         .error = ":12:61: until is not a key of joints[0]; allowed: from, to, stiffness, damping, "
                  "length, begin, end"});
}

#define WELD(text) "\ntime: {h", "\nwelds: [{" text "}]\ntime: {h"

UNIT_TEST(welds_that_cannot_be_made)
{
    EXPECT({WELD("from: {vertex: 1}"),
            .error = ":12:9: welds[0].to is missing; a map of cloth, vertex, vertices is expected"},
           {WELD("from: {vertex: 1}, to: {vertex: 12}"),
            .error =
                ":12:42: vertex 12 is outside the mesh of cloth 'sheet', which has 12 vertices; "
                "0 to 11 are allowed"},
           {WELD("from: {vertices: [1, 2]}, to: {vertex: 3}"),
            .error = ":12:40: a weld has 2 vertices in from and 1 in to; as many are expected"},
           {WELD("from: {vertex: 1, cloth: shet}, to: {vertex: 3}"),
            .error = ":12:35: there is no cloth 'shet'; did you mean 'sheet'? Allowed: sheet"},
           {WELD("from: {vertex: 1}, to: {vertex: 3}, tolerance: -1"),
            .error = ":12:57: welds[0].tolerance is -1; a finite number >= 0 (m) is expected"});
}
