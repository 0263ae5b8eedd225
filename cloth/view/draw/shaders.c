/* Colours are linear until `encode` or `display`, which every fragment passes through last. What
 * lies far away on the ground takes the background's colour at its pixel, so nothing but edges,
 * which come last, has to be blended, and the order of drawing is free. */
#include "cloth/view/draw/draw.h"

/* clang-format off */
const char DRAW_COMMON[] =
    "#version 330 core\n"
    "#define SUN 8\n"
    "#define SKY 48\n"
    "#define LIGHTS (SUN + SKY)\n"
    "uniform mat4 clip;\n"
    "uniform vec3 eye;\n"
    "uniform vec2 size;\n"
    "layout(std140) uniform Lights {\n"
    "    vec4 direction[LIGHTS]; vec4 colour[LIGHTS]; vec4 row[3 * LIGHTS]; vec4 toward; vec4 sunlight; vec4 bias;\n"
    "};\n"
    "uniform sampler2DArrayShadow suns, skies;\n"
    "uniform bool shadows;\n"
    "float noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }\n"
    "vec3 background(vec2 p)\n"
    "{\n"
    "    vec2 q = p / size - 0.5;\n"
    "    vec3 c = mix(vec3(0.60, 0.60, 0.585), vec3(0.30, 0.37, 0.45), smoothstep(-0.35, 0.75, q.y));\n"
    "    return c * (1.0 - 0.35 * dot(q, q));\n"
    "}\n"
    /* The display's curve, and half a step of noise against bands. */
    "vec4 display(vec3 c, vec2 p)\n"
    "{\n"
    "    vec3 low = 12.92 * c, high = 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055;\n"
    "    return vec4(mix(high, low, lessThan(c, vec3(0.0031308))) + (noise(p) - 0.5) / 255.0, 1.0);\n"
    "}\n"
    /* With a soft shoulder before it. */
    "vec4 encode(vec3 c, vec2 p) { return display(1.05 * c / (1.0 + 0.40 * c), p); }\n"
    "vec3 in_map(int i, vec3 at)\n"
    "{\n"
    "    vec4 q = vec4(at, 1.0);\n"
    "    return vec3(dot(row[3 * i], q), dot(row[3 * i + 1], q), dot(row[3 * i + 2], q));\n"
    "}\n"
    /* The sky's light on both sides of a surface, as irradiance / pi. */
    "void sky(vec3 at, vec3 n, out vec3 front, out vec3 back)\n"
    "{\n"
    "    front = back = vec3(0.0);\n"
    "    for (int i = SUN; i < LIGHTS; i++) {\n"
    "        float c = dot(n, direction[i].xyz), seen = 1.0;\n"
    "        vec3 m = in_map(i, at + n * (c < 0.0 ? -bias.z : bias.z));\n"
    "        if (shadows)\n"
    "            seen = texture(skies, vec4(m.xy, float(i - SUN), m.z));\n"
    "        vec3 e = colour[i].rgb * (abs(c) * seen);\n"
    "        if (c < 0.0) back += e; else front += e;\n"
    "    }\n"
    "}\n"
    "float sun_at(int i, vec3 at, vec2 o)\n"
    "{\n"
    "    vec3 m = in_map(i, at);\n"
    "    return texture(suns, vec4(m.xy + o, float(i), m.z));\n"
    "}\n"
    /* How much of the sun is seen. Where one look at each of its lights says the same there is no edge of a shadow; under a wide
     * blur that holds where all of the sun is seen, since what is dark may be narrow. Elsewhere each light is looked at in four places of a square, which is turned and sized for each light otherwise, and for each pixel: so the
     * edges of the lights' shadows melt. */
    "float sun(vec3 at, vec3 n, vec2 p, float blur)\n"
    "{\n"
    "    if (!shadows)\n"
    "        return 1.0;\n"
    "    vec3 q = at + n * (dot(n, toward.xyz) < 0.0 ? -bias.x : bias.x);\n"
    "    float turn = noise(p), grain = noise(p.yx + 37.0), sum = 0.0;\n"
    "    vec2 o = bias.y * blur * vec2(0.7, 0.0);\n"
    "    for (int i = 0; i < SUN; i++, o = vec2(-o.y, o.x))\n"
    "        sum += sun_at(i, q, o);\n"
    "    if (sum > float(SUN) - 0.01 || sum < 0.01 && blur <= 1.0)\n"
    "        return sum / float(SUN);\n"
    "    sum = 0.0;\n"
    "    for (int i = 0; i < SUN; i++) {\n"
    "        float a = 6.2831853 * fract(turn + 0.7548777 * float(i));\n"
    "        o = bias.y * blur * sqrt(fract(grain + 0.5698403 * float(i))) * vec2(cos(a), sin(a));\n"
    "        for (int k = 0; k < 4; k++, o = vec2(-o.y, o.x))\n"
    "            sum += sun_at(i, q, o);\n"
    "    }\n"
    "    return sum / float(4 * SUN);\n"
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

/* The sky's light on vertices, a texel for each. */
const char DRAW_SKY_FRAGMENT[] =
    "uniform sampler2D fronts;\n" /* place and normal of each vertex */
    "layout(location = 0) out vec4 front;\n"
    "layout(location = 1) out vec4 back;\n"
    "void main()\n"
    "{\n"
    "    ivec2 texel = ivec2(gl_FragCoord.xy) * ivec2(2, 1);\n"
    "    vec3 at = texelFetch(fronts, texel, 0).xyz, n = texelFetch(fronts, texel + ivec2(1, 0), 0).xyz;\n"
    "    sky(at, n, front.rgb, back.rgb);\n"
    "}\n";

/* The sky's light on a square of a plane. */
const char DRAW_SKY_GROUND_FRAGMENT[] =
    "uniform vec3 centre, u, v, n;\n"
    "layout(location = 0) out vec4 front;\n"
    "layout(location = 1) out vec4 back;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = 2.0 * gl_FragCoord.xy / size - 1.0;\n"
    "    sky(centre + u * corner.x + v * corner.y, n, front.rgb, back.rgb);\n"
    "}\n";

/* The mean of that light in a disk. */
const char DRAW_SKY_BLUR_FRAGMENT[] =
    "uniform sampler2D fronts;\n"
    "uniform float blur;\n" /* radius, in parts of the square */
    "layout(location = 0) out vec4 front;\n"
    "void main()\n"
    "{\n"
    "    const int PLACES = 32;\n"
    "    front = vec4(0.0);\n"
    "    for (int i = 0; i < PLACES; i++) {\n"
    "        float r = blur * sqrt((float(i) + 0.5) / float(PLACES)), a = 2.3999632 * float(i);\n"
    "        front += texture(fronts, gl_FragCoord.xy / size + r * vec2(cos(a), sin(a))) / float(PLACES);\n"
    "    }\n"
    "}\n";

const char DRAW_CLOTH_VERTEX[] =
    "in vec3 position, normal;\n"
    "in float value;\n"
    "uniform sampler2D fronts, backs;\n" /* the sky's light on vertices */
    "out vec3 at, up, above, below;\n"
    "out float number;\n"
    "flat out float corner;\n" /* the number of the triangle's last corner */
    "void main()\n"
    "{\n"
    "    ivec2 texel = ivec2(gl_VertexID % 1024, gl_VertexID / 1024);\n"
    "    above = texelFetch(fronts, texel, 0).rgb;\n"
    "    below = texelFetch(backs, texel, 0).rgb;\n"
    "    at = position;\n"
    "    number = corner = value;\n"
    "    up = normal;\n"
    "    gl_Position = clip * vec4(position, 1.0);\n"
    "}\n";

/* Light and shadow change how light a colour of a scale or a part is, between half and whole, and nothing else of it, so that it
 * is found on the scale again. A triangle has one part, the one of its last corner. */
const char DRAW_CLOTH_FRAGMENT[] =
    "in vec3 at, up, above, below;\n"
    "in float number;\n"
    "flat in float corner;\n"
    "out vec4 shade;\n"
    "uniform vec3 paint[2];\n" /* of the front and of the back */
    "uniform int colours;\n" /* 0: paint; 1: of `map`, by the number, 0 .. 1; 2: of `map`, the one of the corner's number */
    "uniform int colours_n;\n"
    "uniform vec3 map[16];\n" /* colours_n, sRGB */
    "vec3 decode(vec3 c)\n"
    "{\n"
    "    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThan(c, vec3(0.04045)));\n"
    "}\n"
    "vec3 mapped()\n"
    "{\n"
    "    if (corner < 0.0)\n" /* it has no number */
    "        return vec3(0.5);\n"
    "    if (colours == 2)\n"
    "        return map[min(int(corner + 0.5), colours_n - 1)];\n"
    "    float p = clamp(number, 0.0, 1.0) * float(colours_n - 1);\n"
    "    int i = min(int(p), colours_n - 2);\n"
    "    return mix(map[i], map[i + 1], p - float(i));\n"
    "}\n"
    "void main()\n"
    "{\n"
    "    vec3 n = normalize(up) * (gl_FrontFacing ? 1.0 : -1.0);\n"
    "    vec3 v = normalize(eye - at);\n"
    "    vec3 lit = gl_FrontFacing ? above : below, behind = gl_FrontFacing ? below : above;\n"
    "    float facing = dot(n, toward.xyz);\n"
    "    vec3 e = sunlight.rgb * (abs(facing) * sun(at, n, gl_FragCoord.xy, 1.0));\n"
    "    if (facing < 0.0) behind += e; else lit += e;\n"
    "    lit += vec3(0.26, 0.25, 0.24) * (0.5 - 0.5 * n.y);\n" /* from the floor */
    "    if (colours != 0) {\n"
    "        float light = dot(lit + 0.22 * behind, vec3(0.2126, 0.7152, 0.0722));\n"
    "        shade = display(decode(mapped()) * mix(0.5, 1.0, clamp(light / 1.6, 0.0, 1.0)), gl_FragCoord.xy);\n"
    "        return;\n"
    "    }\n"
    "    vec3 albedo = gl_FrontFacing ? paint[0] : paint[1];\n"
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
    "uniform vec3 centre, n, u_map, v_map;\n" /* to places in the square of the sky's light */
    "uniform vec2 fade;\n"
    "uniform float blur;\n"
    "uniform sampler2D fronts;\n"
    "out vec4 shade;\n"
    "void main()\n"
    "{\n"
    "    float far = smoothstep(fade.x, fade.y, distance(at, centre));\n"
    "    if (far >= 1.0)\n"
    "        discard;\n"
    "    vec3 lit = texture(fronts, 0.5 + 0.5 * vec2(dot(at - centre, u_map), dot(at - centre, v_map))).rgb;\n"
    "    lit += sunlight.rgb * (max(dot(n, toward.xyz), 0.0) * sun(at, n, gl_FragCoord.xy, blur));\n"
    "    vec3 c = vec3(0.36, 0.355, 0.345) * lit;\n"
    "    shade = encode(mix(c, background(gl_FragCoord.xy), far), gl_FragCoord.xy);\n"
    "}\n";
/* clang-format on */
