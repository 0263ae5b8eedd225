/* Surfaces are drawn first, and shaded a pixel at a time. Colours kept between have 8 bits, of
 * roots where they are light, with noise of a step against bands. Colours are linear until
 * `display`, which every pixel passes through last. Ground that is far away takes the background's
 * colour at its pixel, so nothing has to be blended, and the order of drawing is free. */
#include "cloth/view/draw/draw.h"

/* clang-format off */
const char DRAW_COMMON[] =
    "#version 330 core\n"
    "#define SUN 8\n"
    "#define SKY 48\n"
    "#define SUN_RADIUS 0.13\n"
    "#define GOLDEN 2.3999632\n"
    "#define SUNLIGHT vec3(1.62, 1.48, 1.27)\n"
    "#define HORIZON vec3(0.78, 0.76, 0.74)\n"
    "#define ZENITH vec3(0.62, 0.76, 0.98)\n"
    "#define THROUGH 0.22\n" /* of the light on the other side */
    "#define NOTHING 0.0\n"
    "#define READY 1.0\n"
    "#define FIRST 2.0\n"
    "#define PARTS 16.0\n"
    "#define GREY 32.0\n"
    "#define SCALE 33.0\n"
    "uniform mat4 clip;\n"
    "uniform vec3 eye;\n"
    "uniform vec2 size;\n"
    "layout(std140) uniform Lights {\n"
    "    vec4 sky_axis[2 * SKY]; vec4 right; vec4 upward; vec4 toward; vec4 sphere; vec4 bias;\n"
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
    /* The sky's light on both sides of a surface, as irradiance / pi. */
    "void sky(vec3 at, vec3 n, out vec3 front, out vec3 back)\n"
    "{\n"
    "    front = back = vec3(0.0);\n"
    "    for (int i = 0; i < SKY; i++) {\n"
    "        vec3 d = sky_axis[2 * i].xyz, u = sky_axis[2 * i + 1].xyz, v = cross(d, u);\n"
    "        float c = dot(n, d), seen = 1.0;\n"
    "        vec3 q = (at + n * (c < 0.0 ? -bias.z : bias.z) - sphere.xyz) * sphere.w;\n"
    "        if (shadows)\n"
    "            seen = texture(skies, vec4(0.5 + dot(u, q), 0.5 + dot(v, q), float(i), 0.5 - dot(d, q)));\n"
    /* A level surface sees half the sum of the weights. */
    "        vec3 e = mix(HORIZON, ZENITH, d.y) * (abs(c) * seen * 2.0 / float(SKY));\n"
    "        if (c < 0.0) back += e; else front += e;\n"
    "    }\n"
    "}\n"
    /* A place in the sun's maps: x, y, height towards the sun, of their width. */
    "vec3 in_sun(vec3 at)\n"
    "{\n"
    "    vec3 q = (at - sphere.xyz) * sphere.w;\n"
    "    return vec3(dot(right.xyz, q), dot(upward.xyz, q), dot(toward.xyz, q));\n"
    "}\n"
    "float sun_at(int i, vec3 q, vec2 o)\n"
    "{\n"
    "    float a = GOLDEN * float(i), r = SUN_RADIUS * sqrt((float(i) + 0.5) / float(SUN));\n"
    "    return texture(suns, vec4(0.5 + q.xy - q.z * r * vec2(cos(a), sin(a)) + o, float(i), 0.5 - q.z));\n"
    "}\n"
    /* How much of the sun is seen. Where one look at each of its lights says the same there is no edge of a shadow. Elsewhere each
     * light is looked at in four more places of a square, which is turned and sized for each light otherwise, and for each pixel:
     * so the edges of the lights' shadows melt. Software renderers run what a loop without a known end has once for all pixels,
     * what it has before its last test once more. */
    "float sun(vec3 at, vec3 n, vec2 p, bool looked)\n"
    "{\n"
    "    vec3 q = in_sun(at + n * (dot(n, toward.xyz) < 0.0 ? -bias.x : bias.x));\n"
    "    float turn = noise(p), grain = noise(p.yx + 37.0), sum = 0.0;\n"
    "    int i = 0, end = looked ? SUN : 1;\n"
    "    do {\n"
    "        int light = i < SUN ? i : (i - SUN) / 4;\n"
    "        float a = i < SUN ? 0.0 : fract(turn + 0.7548777 * float(light)), r = i < SUN ? 0.5 : fract(grain + 0.5698403 * float(light));\n"
    "        a = 6.2831853 * (a + 0.25 * float(i));\n"
    "        sum += sun_at(light, q, bias.y * sqrt(r) * vec2(cos(a), sin(a)));\n"
    "        i++;\n"
    "        if (i == SUN && looked && sum > 0.01 && sum < float(SUN) - 0.01)\n"
    "            end = 5 * SUN;\n"
    "    } while (i < end);\n"
    "    return looked ? sum / float(end) : 1.0;\n"
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

/* One triangle over everything. */
const char DRAW_ALL_VERTEX[] =
    "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 1.0, 1.0); }\n";

/* The sky's light on vertices, a texel for each. Some of it shines through. */
const char DRAW_SKY_FRAGMENT[] =
    "uniform sampler2D fronts;\n" /* place and normal of each vertex */
    "layout(location = 0) out vec4 front;\n"
    "layout(location = 1) out vec4 back;\n"
    "void main()\n"
    "{\n"
    "    ivec2 texel = ivec2(gl_FragCoord.xy) * ivec2(2, 1);\n"
    "    vec3 at = texelFetch(fronts, texel, 0).xyz, n = texelFetch(fronts, texel + ivec2(1, 0), 0).xyz;\n"
    "    vec3 e[2];\n"
    "    sky(at, n, e[0], e[1]);\n"
    "    front = vec4(e[0] + THROUGH * e[1], 1.0);\n"
    "    back = vec4(e[1] + THROUGH * e[0], 1.0);\n"
    "}\n";

/* The sky's light on a square of a plane. */
const char DRAW_SKY_SQUARE_FRAGMENT[] =
    "uniform vec3 centre, u, v, n;\n"
    "layout(location = 0) out vec4 front;\n"
    "layout(location = 1) out vec4 back;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = 2.0 * gl_FragCoord.xy / size - 1.0;\n"
    "    sky(centre + u * corner.x + v * corner.y, n, front.rgb, back.rgb);\n"
    "}\n";

/* How much of the sun is seen from there. */
const char DRAW_SUN_SQUARE_FRAGMENT[] =
    "uniform vec3 centre, u, v, n;\n"
    "layout(location = 0) out vec4 front;\n"
    "void main()\n"
    "{\n"
    "    vec2 corner = 2.0 * gl_FragCoord.xy / size - 1.0;\n"
    "    vec3 q = in_sun(centre + u * corner.x + v * corner.y + n * bias.x);\n"
    "    front = vec4(0.0);\n"
    "    for (int i = 0; i < SUN; i++)\n"
    "        front += sun_at(i, q, vec2(0.0)) / float(SUN);\n"
    "}\n";

/* The mean of such a square in a disk. */
const char DRAW_BLUR_FRAGMENT[] =
    "uniform sampler2D fronts;\n"
    "uniform float blur;\n" /* radius, in parts of the square */
    "layout(location = 0) out vec4 front;\n"
    "void main()\n"
    "{\n"
    "    const int PLACES = 24;\n"
    "    front = vec4(0.0);\n"
    "    for (int i = 0; i < PLACES; i++) {\n"
    "        float r = blur * sqrt((float(i) + 0.5) / float(PLACES)), a = 2.3999632 * float(i);\n"
    "        front += texture(fronts, gl_FragCoord.xy / size + r * vec2(cos(a), sin(a))) / float(PLACES);\n"
    "    }\n"
    "}\n";

const char DRAW_SURFACE_VERTEX[] =
    "in vec3 position, normal;\n"
    "in float value;\n"
    "uniform sampler2D fronts, backs;\n" /* the sky's light on vertices */
    "out vec3 up, above, below;\n"
    "out float number;\n"
    "flat out float corner;\n" /* the number of the triangle's last corner */
    "void main()\n"
    "{\n"
    "    ivec2 texel = ivec2(gl_VertexID % 1024, gl_VertexID / 1024);\n"
    "    above = texelFetch(fronts, texel, 0).rgb;\n"
    "    below = texelFetch(backs, texel, 0).rgb;\n"
    "    number = corner = value;\n"
    "    up = normal;\n"
    "    gl_Position = clip * vec4(position, 1.0);\n"
    "}\n";

/* A triangle has one part, the one of its last corner. */
const char DRAW_SURFACE_FRAGMENT[] =
    "in vec3 up, above, below;\n"
    "in float number;\n"
    "flat in float corner;\n"
    "layout(location = 0) out vec4 surface;\n"
    "layout(location = 1) out vec4 light;\n"
    "uniform int colours;\n" /* 0: paint; 1: of a scale, by the number, 0 .. 1; 2: of parts, by the corner's number */
    "uniform float paint, parts, edge;\n" /* of the front; the last part's number; 1 of edges */
    "void main()\n"
    "{\n"
    "    float code = gl_FrontFacing ? paint : paint + 1.0, grain = (noise(gl_FragCoord.xy) - 0.5) / 255.0;\n"
    "    vec3 n = normalize(gl_FrontFacing ? up : -up), lit = gl_FrontFacing ? above : below;\n"
    "    if (colours == 1)\n"
    "        code = mix(SCALE, 255.0, clamp(number, 0.0, 1.0));\n"
    "    if (colours == 2)\n"
    "        code = PARTS + min(floor(corner + 0.5), parts);\n"
    "    if (colours != 0 && corner < 0.0)\n" /* it has no number */
    "        code = GREY;\n"
    "    surface = vec4(0.5 + 0.5 * n + grain, code / 255.0);\n"
    "    light = vec4(sqrt(0.5 * lit) + grain, edge);\n"
    "}\n";

const char DRAW_GROUND_VERTEX[] =
    "uniform vec3 centre, u, v;\n"
    "uniform vec3 sky_square, sun_square;\n" /* offset and scale, to places in the squares of light */
    "out vec2 corner, in_sky_square, in_sun_square;\n"
    "void main()\n"
    "{\n"
    "    corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;\n"
    "    vec3 at = centre + u * corner.x + v * corner.y;\n"
    "    vec2 place = vec2(dot(at, normalize(u)), dot(at, normalize(v)));\n"
    "    in_sky_square = sky_square.xy + sky_square.z * place;\n"
    "    in_sun_square = sun_square.xy + sun_square.z * place;\n"
    "    gl_Position = clip * vec4(at, 1.0);\n"
    "}\n";

const char DRAW_GROUND_FRAGMENT[] =
    "in vec2 corner, in_sky_square, in_sun_square;\n"
    "uniform vec3 n;\n"
    "uniform sampler2D fronts, backs;\n" /* light of the sky; of the sun */
    "layout(location = 0) out vec4 surface;\n"
    "void main()\n"
    "{\n"
    "    float far = smoothstep(0.15, 1.0, length(corner));\n"
    "    if (far >= 1.0)\n"
    "        discard;\n"
    "    float seen = shadows ? texture(backs, in_sun_square).r : 1.0;\n"
    "    vec3 lit = texture(fronts, in_sky_square).rgb + SUNLIGHT * (max(dot(n, toward.xyz), 0.0) * seen);\n"
    "    vec3 c = mix(vec3(0.36, 0.355, 0.345) * lit, background(gl_FragCoord.xy), far);\n"
    "    surface = vec4(sqrt(c) + (noise(gl_FragCoord.xy) - 0.5) / 255.0, READY / 255.0);\n"
    "}\n";

/* Where all samples of a pixel are of one surface it is shaded once, as their mean. Light and shadow change how light a colour of a
 * scale or a part is, between half and whole, and nothing else of it, so that it is found on the scale again. */
const char DRAW_SHADE_FRAGMENT[] =
    "uniform sampler2DMS surfaces, lights, depths;\n"
    "uniform int samples;\n"
    "uniform float ink;\n" /* how dark edges are */
    "uniform mat4 world;\n" /* the inverse of clip */
    "uniform float pixel;\n" /* its width, of its distance */
    "uniform sampler2D fronts;\n" /* the colours of paints, linear */
    "out vec4 shade;\n"
    "vec3 display(vec3 c)\n"
    "{\n"
    "    vec3 low = 12.92 * c, high = 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055;\n"
    "    return mix(high, low, lessThan(c, vec3(0.0031308)));\n"
    "}\n"
    "vec4 place(float depth)\n"
    "{\n"
    "    return world * vec4(vec3(gl_FragCoord.xy / size, depth) * 2.0 - 1.0, 1.0);\n"
    "}\n"
    /* surface: its paint in whole numbers */
    "vec3 shaded(vec4 surface, vec4 kept, float depth)\n"
    "{\n"
    "    float code = surface.a;\n"
    "    bool solid = code >= FIRST;\n"
    "    vec4 q = place(depth);\n"
    "    vec3 at = q.xyz / q.w, n = normalize(2.0 * surface.rgb - 1.0), v = normalize(eye - at), light = 2.0 * kept.rgb * kept.rgb;\n"
    "    float facing = dot(n, toward.xyz);\n"
    "    light += SUNLIGHT * (abs(facing) * sun(at, n, gl_FragCoord.xy, solid && shadows) * (facing < 0.0 ? THROUGH : 1.0));\n"
    "    light += vec3(0.26, 0.25, 0.24) * (0.5 - 0.5 * n.y);\n" /* from the floor */
    "    vec3 c = code == NOTHING ? background(gl_FragCoord.xy) : surface.rgb * surface.rgb;\n"
    "    vec3 albedo = texelFetch(fronts, ivec2(code + 0.5, 0), 0).rgb;\n"
    "    if (solid && code < PARTS) {\n"
    "        float rim = pow(1.0 - clamp(dot(n, v), 0.0, 1.0), 4.0);\n"
    "        c = (albedo + rim * 0.22 * mix(albedo, vec3(0.6), 0.25)) * light;\n"
    "    }\n"
    "    c = 1.05 * c / (1.0 + 0.40 * c);\n" /* a soft shoulder */
    "    if (code >= PARTS)\n"
    "        c = albedo * mix(0.5, 1.0, clamp(dot(light, vec3(0.2126, 0.7152, 0.0722)) / 1.6, 0.0, 1.0));\n"
    "    c = display(c);\n"
    "    if (code == NOTHING)\n"
    "        c += (noise(gl_FragCoord.xy) - 0.5) / 255.0;\n"
    "    return solid ? mix(c, vec3(0.12), ink * kept.a) : c;\n"
    "}\n"
    "float kind(float code) { return min(code, SCALE); }\n"
    /* True if samples of one kind, with this mean, lie no farther apart than a pixel of the surface reaches. */
    "bool joined(vec4 surface, float near, float far)\n"
    "{\n"
    "    vec4 q = place(near);\n"
    "    float facing = abs(dot(normalize(2.0 * surface.rgb - 1.0), normalize(eye - q.xyz / q.w)));\n"
    "    float apart = 2.0 * abs(world[2][3]) * (far - near) / q.w;\n" /* of the distance, which is 1 / w */
    "    return surface.a < FIRST || apart * max(facing, 0.05) < 3.0 * pixel;\n"
    "}\n"
    "vec4 surface_at(ivec2 p, int i) { return texelFetch(surfaces, p, i) * vec4(1.0, 1.0, 1.0, 255.0); }\n"
    "void main()\n"
    "{\n"
    "    ivec2 p = ivec2(gl_FragCoord.xy);\n"
    "    vec4 mean = surface_at(p, 0);\n"
    "    float code = kind(mean.a), near = texelFetch(depths, p, 0).r, far = near;\n"
    "    bool same = ink == 0.0;\n"
    "    for (int i = 1; i < samples; i++) {\n"
    "        vec4 other = surface_at(p, i);\n"
    "        float depth = texelFetch(depths, p, i).r;\n"
    "        same = same && kind(other.a) == code;\n"
    "        near = min(near, depth);\n"
    "        far = max(far, depth);\n"
    "        mean += other;\n"
    "    }\n"
    "    mean /= float(samples);\n"
    "    same = same && joined(mean, near, far);\n"
    "    vec3 sum = vec3(0.0);\n"
    "    int i = 0, n = same ? 1 : samples;\n"
    "    do\n"
    "        sum += shaded(same ? mean : surface_at(p, i), texelFetch(lights, p, i), texelFetch(depths, p, i).r);\n"
    "    while (++i < n);\n"
    "    shade = vec4(sum / float(n), 1.0);\n"
    "}\n";
/* clang-format on */
