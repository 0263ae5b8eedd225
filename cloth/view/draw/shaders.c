/* Colours are linear until `encode`, which every fragment passes through last. What lies far away
 * on the ground takes the background's colour at its pixel, so nothing has to be blended and the
 * order of drawing is free. */
#include "cloth/view/draw/draw.h"

/* clang-format off */
const char DRAW_COMMON[] =
    "#version 330 core\n"
    "#define LIGHTS 72\n"
    "#define SUN 24\n"
    "uniform mat4 clip;\n"
    "uniform vec3 eye;\n"
    "uniform vec2 size;\n"
    "layout(std140) uniform Lights {\n"
    "    vec4 direction[LIGHTS]; vec4 colour[LIGHTS]; vec4 row[3 * LIGHTS]; vec4 bias;\n"
    "};\n"
    "uniform sampler2DArrayShadow maps;\n"
    "uniform int looks;\n" /* into each map, 4; 0: without shadows */
    "float noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }\n"
    "vec3 background(vec2 p)\n"
    "{\n"
    "    vec2 q = p / size - 0.5;\n"
    "    vec3 c = mix(vec3(0.60, 0.60, 0.585), vec3(0.30, 0.37, 0.45), smoothstep(-0.35, 0.75, q.y));\n"
    "    return c * (1.0 - 0.35 * dot(q, q));\n"
    "}\n"
    /* A soft shoulder, the display's curve, and half a step of noise against bands. */
    "vec4 encode(vec3 c, vec2 p)\n"
    "{\n"
    "    c = 1.05 * c / (1.0 + 0.40 * c);\n"
    "    vec3 low = 12.92 * c, high = 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055;\n"
    "    return vec4(mix(high, low, lessThan(c, vec3(0.0031308))) + (noise(p) - 0.5) / 255.0, 1.0);\n"
    "}\n"
    /* Light that reaches both sides of a surface at `at`, as irradiance / pi. Sun and sky are few directions: where they fall
     * on what throws no shadow itself, their maps are blurred so that their edges melt. Each light takes the mean of four places
     * in a square around the point, which is turned and sized for each light otherwise, and for each pixel: what varies evenly
     * then has no grain. */
    "void gather(vec3 at, vec3 n, vec2 p, float blur, out vec3 front, out vec3 back)\n"
    "{\n"
    "    front = back = vec3(0.0);\n"
    "    float turn = noise(p), grain = noise(p.yx + 37.0);\n"
    "    for (int i = 0; i < LIGHTS; i++) {\n"
    "        float c = dot(n, direction[i].xyz);\n"
    "        vec4 q = vec4(at + n * (c < 0.0 ? -bias.x : bias.x), 1.0);\n"
    "        vec3 m = vec3(dot(row[3 * i], q), dot(row[3 * i + 1], q), dot(row[3 * i + 2], q));\n"
    "        float a = 6.2831853 * fract(turn + 0.7548777 * float(i));\n"
    "        float r = sqrt(fract(grain + 0.5698403 * float(i)));\n"
    "        vec2 o = (i < SUN ? min(blur, 2.0) : blur) * bias.y * r * vec2(cos(a), sin(a));\n"
    "        float seen = looks > 0 ? 0.0 : 1.0;\n"
    "        for (int k = 0; k < looks; k++, o = vec2(-o.y, o.x))\n"
    "            seen += 0.25 * texture(maps, vec4(m.xy + o, float(i), m.z));\n"
    "        vec3 e = colour[i].rgb * (abs(c) * seen);\n"
    "        if (c < 0.0) back += e; else front += e;\n"
    "    }\n"
    "}\n";

const char DRAW_CAST_VERTEX[] =
    "in vec3 position;\n"
    "uniform vec4 map[3];\n"
    "void main()\n"
    "{\n"
    "    vec4 q = vec4(position, 1.0);\n"
    "    gl_Position = vec4(2.0 * vec3(dot(map[0], q), dot(map[1], q), dot(map[2], q)) - 1.0, 1.0);\n"
    "}\n";

const char DRAW_CAST_FRAGMENT[] =
    "void main() {}\n";

const char DRAW_BACK_VERTEX[] =
    "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 1.0, 1.0); }\n";

const char DRAW_BACK_FRAGMENT[] =
    "out vec4 shade;\n"
    "void main() { shade = encode(background(gl_FragCoord.xy), gl_FragCoord.xy); }\n";

const char DRAW_CLOTH_VERTEX[] =
    "in vec3 position, normal;\n"
    "in float heat;\n"
    "out vec3 at, up;\n"
    "out float hot;\n"
    "void main()\n"
    "{\n"
    "    at = position;\n"
    "    hot = heat;\n"
    "    up = normal;\n"
    "    gl_Position = clip * vec4(position, 1.0);\n"
    "}\n";

const char DRAW_CLOTH_FRAGMENT[] =
    "in vec3 at, up;\n"
    "in float hot;\n"
    "out vec4 shade;\n"
    "uniform vec3 paint[2];\n" /* of the front and of the back */
    "void main()\n"
    "{\n"
    "    vec3 n = normalize(up) * (gl_FrontFacing ? 1.0 : -1.0);\n"
    "    vec3 v = normalize(eye - at), lit, behind;\n"
    "    gather(at, n, gl_FragCoord.xy, 1.0, lit, behind);\n"
    "    vec3 albedo = gl_FrontFacing ? paint[0] : paint[1];\n"
    "    if (hot > 0.0)\n" /* red, then yellow */
    "        albedo = mix(mix(albedo, vec3(0.75, 0.04, 0.01), clamp(2.0 * hot, 0.0, 1.0)),\n"
    "                     vec3(0.95, 0.80, 0.10), clamp(2.0 * hot - 1.0, 0.0, 1.0));\n"
    "    lit += vec3(0.26, 0.25, 0.24) * (0.5 - 0.5 * n.y);\n" /* from the floor */
    "    float rim = pow(1.0 - clamp(dot(n, v), 0.0, 1.0), 4.0);\n"
    "    vec3 c = albedo * (lit + 0.22 * behind);\n"
    "    c += rim * 0.22 * mix(albedo, vec3(0.6), 0.25) * lit;\n"
    "    shade = encode(c, gl_FragCoord.xy);\n"
    "}\n";

const char DRAW_GROUND_VERTEX[] =
    "uniform vec3 centre, u, v;\n"
    "out vec3 at;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;\n"
    "    at = centre + u * corner.x + v * corner.y;\n"
    "    gl_Position = clip * vec4(at, 1.0);\n"
    "}\n";

const char DRAW_GROUND_FRAGMENT[] =
    "in vec3 at;\n"
    "uniform vec3 centre, n;\n"
    "uniform vec2 fade;\n"
    "uniform float blur;\n"
    "out vec4 shade;\n"
    "void main()\n"
    "{\n"
    "    float far = smoothstep(fade.x, fade.y, distance(at, centre));\n"
    "    if (far >= 1.0)\n"
    "        discard;\n"
    "    vec3 lit, behind;\n"
    "    gather(at, n, gl_FragCoord.xy, blur, lit, behind);\n"
    "    vec3 c = vec3(0.36, 0.355, 0.345) * lit;\n"
    "    shade = encode(mix(c, background(gl_FragCoord.xy), far), gl_FragCoord.xy);\n"
    "}\n";
/* clang-format on */
