// SPDX-License-Identifier: Apache-2.0
#include "shaders.h"

namespace osd_shading::viewer {

namespace {

char const kHeader[] = "#version 330 core\n";

char const kSurfaceVertex[] = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 leftNormal;
layout(location = 2) in vec3 rightNormal;
layout(location = 3) in float weight;
layout(location = 4) in float curvature;
uniform mat4 view, projection;
out vec3 eyePosition, eyeLeft, eyeRight;
out float share;
void main() {
    vec4 eye = view * vec4(position, 1);
    eyePosition = eye.xyz;
    eyeLeft = mat3(view) * leftNormal;
    eyeRight = mat3(view) * rightNormal;
    share = MODE == WEIGHT ? weight : curvature;
    gl_Position = projection * eye;
}
)";

// The whole picture is made in eye space: the eye at the origin, looking along -z.
char const kSurfaceFragment[] = R"(
in vec3 eyePosition, eyeLeft, eyeRight;
in float share;
uniform mat4 view;
uniform samplerBuffer faceNormals;
uniform int trianglesPerFace;
uniform float lineCount, lineAngle, roughness, range;
uniform vec3 scale[5];
out vec4 color;

const float kPi = 3.14159265;

vec3 onScale(float x) {
    x = clamp(x, 0.0, 1.0) * 4.0;
    int i = int(min(x, 3.0));
    return mix(scale[i], scale[i + 1], x - float(i));
}

// A normal of some length, towards the eye's side of the surface; where there is none, the triangle's own.
vec3 prepared(vec3 normal, bool isFace) {
    if (isFace) normal = mat3(view) * texelFetch(faceNormals, gl_PrimitiveID / trianglesPerFace).xyz;
    float squared = dot(normal, normal);
    if (squared < 1e-12) return normalize(cross(dFdx(eyePosition), dFdy(eyePosition)));
    return normal * inversesqrt(squared) * (gl_FrontFacing ? 1.0 : -1.0);
}

// Share of a pixel, `width` wide at `x`, that lies on a band: [0, 1/2) of each period 1.
float band(float x, float width) {
    width = max(width, 1e-4);
    vec2 ends = x + vec2(-0.5, 0.5) * width;
    vec2 sums = floor(ends) * 0.5 + min(fract(ends), 0.5);
    return (sums.y - sums.x) / width;
}

// The same for `count` bands round the circle by the direction of `v`, whose angle jumps but whose bands do not.
float angularBand(vec2 v, float count) {
    float perRadian = count / (2.0 * kPi);
    vec2 dx = dFdx(v), dy = dFdy(v);
    float squared = max(dot(v, v), 1e-8);
    float width = (abs(v.x * dx.y - v.y * dx.x) + abs(v.x * dy.y - v.y * dy.x)) / squared;
    return band(atan(v.y, v.x) * perRadian + 0.25, width * perRadian);
}

// The lobe of GGX microfacets with its peak at 1: a highlight, not a measurement.
float highlight(vec3 normal, vec3 light, vec3 toEye) {
    float alpha = max(roughness * roughness, 0.003);
    float cosine = max(dot(normal, normalize(light + toEye)), 0.0);
    float d = (cosine * cosine * (alpha * alpha - 1.0) + 1.0) / (alpha * alpha);
    return max(dot(normal, light), 0.0) * (1.0 - 0.7 * roughness) / (d * d);
}

void main() {
    vec3 normal = prepared(eyeLeft, LEFT_IS_FACE);
    vec3 toEye = normalize(-eyePosition);
    vec3 shade = vec3(0);

    if (MODE == LIT) {
        vec3 key = normalize(vec3(-0.5, 0.7, 0.6)), head = vec3(0, 0, 1);
        float diffuse = 0.10 + 0.55 * max(dot(normal, key), 0.0) + 0.25 * max(dot(normal, head), 0.0);
        shade = vec3(0.60, 0.64, 0.70) * diffuse + 0.5 * highlight(normal, key, toEye) +
                0.25 * highlight(normal, head, toEye);
        shade = pow(shade, vec3(1.0 / 2.2));
    } else if (MODE == HIGHLIGHT) {
        // Lights at infinity, parallel to `along`: which of them is seen depends on the angle about it alone.
        vec3 along = vec3(cos(lineAngle), sin(lineAngle), 0), across = vec3(-along.y, along.x, 0);
        vec3 reflected = reflect(-toEye, normal);
        float bandShare = angularBand(vec2(reflected.z, dot(reflected, across)), lineCount);
        shade = mix(vec3(0.05, 0.12, 0.62), vec3(0.45, 0.95, 1.0), bandShare);
        shade *= 0.78 + 0.22 * max(dot(normal, toEye), 0.0);
    } else if (MODE == ISOPHOTES) {
        float angle = acos(clamp(dot(normal, vec3(0, 0, 1)), -1.0, 1.0)) / kPi * lineCount;
        shade = mix(vec3(0.13, 0.14, 0.16), vec3(0.96), band(angle, fwidth(angle)));
    } else if (MODE == ZEBRA) {
        vec3 reflected = transpose(mat3(view)) * reflect(-toEye, normal);
        float height = asin(clamp(reflected.y, -1.0, 1.0)) / kPi * lineCount;
        shade = mix(vec3(0.03), vec3(0.97), band(height + 0.25, fwidth(height)));
    } else if (MODE == NORMAL) {
        shade = 0.5 + 0.5 * (transpose(mat3(view)) * normal);
    } else if (MODE == WEIGHT) {
        shade = onScale(share);
    } else if (MODE == CURVATURE) {
        shade = onScale(0.5 + 0.5 * (gl_FrontFacing ? share : -share) / range);
    } else if (MODE == FACING) {
        float cosine = dot(normal, toEye);
        shade = gl_FrontFacing ? vec3(0.45, 0.62, 0.80) : vec3(0.93, 0.58, 0.25);
        shade = cosine < 0.0 ? vec3(0.85, 0.05, 0.55) : shade * (0.55 + 0.45 * cosine);
    } else if (MODE == DIFFERENCE) {
        vec3 other = prepared(eyeRight, RIGHT_IS_FACE);
        shade = onScale(degrees(atan(length(cross(normal, other)), dot(normal, other))) / range);
    }
    color = vec4(shade, 1);
}
)";

char const kPointFetch[] = R"(
uniform samplerBuffer points;
uniform int stride, first;
uniform mat4 view, projection;
uniform float lift;
// A point in eye space, brought nearer to the eye by a share of its distance: it stays where it is on the screen.
vec3 eyePoint(int i) {
    i = first + i * stride;
    vec3 p = vec3(texelFetch(points, i).x, texelFetch(points, i + 1).x, texelFetch(points, i + 2).x);
    return (view * vec4(p, 1)).xyz * (1.0 - lift);
}
)";

char const kLineVertex[] = R"(
layout(location = 0) in ivec2 ends;
layout(location = 1) in vec4 lineColor;
uniform vec2 viewport;
uniform float width, near;
out vec4 vertexColor;
void main() {
    vec3 a = eyePoint(ends.x), b = eyePoint(ends.y);
    // What is behind the eye has no place on the screen: cut there.
    if (a.z > -near && b.z < -near) a = mix(a, b, (a.z + near) / (a.z - b.z));
    if (b.z > -near && a.z < -near) b = mix(b, a, (b.z + near) / (b.z - a.z));
    vec4 clipA = projection * vec4(a, 1), clipB = projection * vec4(b, 1);
    vec2 along = (clipB.xy / clipB.w - clipA.xy / clipA.w) * viewport;
    along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1, 0);
    float side = float(gl_VertexID & 1) * 2.0 - 1.0;
    bool isFirst = gl_VertexID < 2;
    vec4 clip = isFirst ? clipA : clipB;
    // Half a width beyond the ends closes the gaps between the pieces of a curve.
    vec2 offset = vec2(-along.y, along.x) * side + along * (isFirst ? -0.5 : 0.5);
    clip.xy += offset * width / viewport * clip.w;
    gl_Position = clip;
    vertexColor = lineColor;
}
)";

char const kLineFragment[] = R"(
in vec4 vertexColor;
uniform float opacity;
out vec4 color;
void main() { color = vec4(vertexColor.rgb, vertexColor.a * opacity); }
)";

char const kMarkVertex[] = R"(
layout(location = 0) in ivec2 mark;  // point, number
layout(location = 1) in vec4 markColor;
uniform vec2 viewport;
uniform float width;
out vec2 place;
out vec4 vertexColor;
flat out int number;
void main() {
    place = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec4 clip = projection * vec4(eyePoint(mark.x), 1);
    clip.xy += place * width / viewport * clip.w;
    gl_Position = clip;
    vertexColor = markColor;
    number = mark.y;
}
)";

// Digits of 3 x 5 dots, bit 3 * row + column, rows from the top.
char const kMarkFragment[] = R"(
in vec2 place;
in vec4 vertexColor;
flat in int number;
out vec4 color;
const int kDigits[10] = int[10](31599, 29850, 29671, 31207, 18925, 31183, 31695, 18727, 31727, 31215);
bool isDot(int digit, ivec2 at) {
    if (at.x < 0 || at.x > 2 || at.y < 0 || at.y > 4) return false;
    return (kDigits[digit] >> (3 * (4 - at.y) + at.x) & 1) != 0;
}
void main() {
    float radius = length(place);
    if (radius > 1.0) discard;
    vec3 shade = radius > 0.86 ? vec3(1) : vertexColor.rgb;
    if (number >= 0) {
        ivec2 at = ivec2(floor(place * 4.6 + vec2(number > 9 ? 3.5 : 1.5, 2.5)));
        bool isLit = number > 9 ? isDot(number / 10 % 10, at) || isDot(number % 10, at - ivec2(4, 0))
                                : isDot(number, at);
        if (isLit) shade = vec3(1);
    }
    color = vec4(shade, 1);
}
)";

char const kFlatVertex[] = R"(
layout(location = 0) in vec3 position;
uniform mat4 view, projection;
uniform float lift;
void main() { gl_Position = projection * vec4((view * vec4(position, 1)).xyz * (1.0 - lift), 1); }
)";

char const kFlatFragment[] = R"(
uniform vec4 flatColor;
out vec4 color;
void main() { color = flatColor; }
)";

std::string Define(std::string const& name, int value) {
    return "#define " + name + " " + std::to_string(value) + "\n";
}

}  // namespace

ShaderPair SurfaceShaders(ShadingMode mode, bool leftIsFace, bool rightIsFace) {
    std::string defines = kHeader;
    static constexpr OptionNames<ShadingMode, 9> kWords = {{{"LIT", ShadingMode::Lit},
                                                            {"HIGHLIGHT", ShadingMode::Highlight},
                                                            {"ISOPHOTES", ShadingMode::Isophotes},
                                                            {"ZEBRA", ShadingMode::Zebra},
                                                            {"NORMAL", ShadingMode::Normal},
                                                            {"WEIGHT", ShadingMode::Weight},
                                                            {"CURVATURE", ShadingMode::Curvature},
                                                            {"FACING", ShadingMode::Facing},
                                                            {"DIFFERENCE", ShadingMode::Difference}}};
    for (auto const& [word, value] : kWords) defines += Define(std::string(word), static_cast<int>(value));
    defines += Define("MODE", static_cast<int>(mode));
    defines += std::string("#define LEFT_IS_FACE ") + (leftIsFace ? "true\n" : "false\n");
    defines += std::string("#define RIGHT_IS_FACE ") + (rightIsFace ? "true\n" : "false\n");
    return {defines + kSurfaceVertex, defines + kSurfaceFragment};
}

ShaderPair LineShaders() {
    return {std::string(kHeader) + kPointFetch + kLineVertex, std::string(kHeader) + kLineFragment};
}

ShaderPair MarkShaders() {
    return {std::string(kHeader) + kPointFetch + kMarkVertex, std::string(kHeader) + kMarkFragment};
}

ShaderPair FlatShaders() { return {std::string(kHeader) + kFlatVertex, std::string(kHeader) + kFlatFragment}; }

}  // namespace osd_shading::viewer
