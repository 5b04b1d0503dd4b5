#version 300 es
precision highp float;

uniform int mode;
// 0: before, 1: after.
uniform int side;
// Pixels of the device in one of the page.
uniform float thickness;

in vec3 normal;
in vec3 share;
in float energy;
flat in vec3 faceNormal;
flat in vec3 dihedral;
flat in vec3 flipped;
out vec4 colour;

const int FACES = 0, WIRES = 1, ENERGY = 2, DIHEDRAL = 3, FLIPS = 4, REFLECTION = 5;
const vec3 CLAY = vec3(0.87, 0.85, 0.82);
const vec3 PAPER = vec3(0.96, 0.955, 0.945);
const vec3 BEHIND = vec3(0.55, 0.62, 0.70);
const vec3 INK = vec3(0.10, 0.12, 0.15);
const vec3 REMOVED = vec3(0.80, 0.25, 0.02);
const vec3 ADDED = vec3(0.00, 0.42, 0.75);
// As in the legend.
const vec3 RAMP[6] = vec3[](
  vec3(0.98, 0.96, 0.82), vec3(0.997, 0.76, 0.53), vec3(0.96, 0.44, 0.36),
  vec3(0.72, 0.22, 0.47), vec3(0.40, 0.10, 0.50), vec3(0.11, 0.06, 0.26));

vec3 ramp(float t) {
  float place = clamp(t, 0.0, 1.0) * 5.0;
  int low = min(int(place), 4);
  return mix(RAMP[low], RAMP[low + 1], place - float(low));
}

float light(vec3 n) {
  return 0.30 + 0.28 * n.z + 0.46 * max(dot(n, vec3(-0.48, 0.52, 0.71)), 0.0);
}

void main() {
  bool isBehind = faceNormal.z < 0.0;
  vec3 n = isBehind ? -faceNormal : faceNormal;
  float shade = light(n);
  vec3 base = isBehind ? BEHIND : CLAY;

  // How far the pixel is from the sides that begin at the corners, in pixels, and how high the
  // triangle is over each: lines fade where it has no room for them.
  vec3 distance = share.zxy;
  vec3 slope = max(sqrt(pow(dFdx(distance), vec3(2)) + pow(dFdy(distance), vec3(2))), 1e-9);
  vec3 pixels = distance / slope / thickness;
  vec3 room = smoothstep(1.5, 9.0, 1.0 / slope / thickness);

  if (mode == FACES) {
    base *= shade;
  } else if (mode == WIRES) {
    vec3 lines = (1.0 - smoothstep(0.2, 1.0, pixels)) * mix(vec3(0.22), vec3(0.9), room);
    base = mix((isBehind ? BEHIND : PAPER) * mix(1.0, shade, 0.35), INK, max(lines.x, max(lines.y, lines.z)));
  } else if (mode == ENERGY) {
    base = ramp(energy) * mix(1.0, shade, 0.35);
  } else if (mode == DIHEDRAL) {
    vec3 bend = sqrt(dihedral);
    vec3 lines = (1.0 - smoothstep(0.7, 1.6, pixels)) * step(0.004, dihedral);
    float worst = max(bend.x, max(bend.y, bend.z));
    vec3 ground = mix(ramp(worst), PAPER, max(room.x, max(room.y, room.z)));
    float top = max(max(lines.x * bend.x, lines.y * bend.y), lines.z * bend.z);
    float cover = max(lines.x, max(lines.y, lines.z));
    base = mix(ground, ramp(top), cover) * mix(1.0, shade, 0.3);
  } else if (mode == FLIPS) {
    vec3 mark = side == 0 ? REMOVED : ADDED;
    vec3 wires = (1.0 - smoothstep(0.1, 0.8, pixels)) * room * 0.35;
    vec3 lines = (1.0 - smoothstep(1.0, 1.8, pixels)) * flipped * room;
    float count = min(flipped.x + flipped.y + flipped.z, 1.0);
    float tint = count * mix(0.85, 0.22, max(room.x, max(room.y, room.z)));
    base = mix((isBehind ? BEHIND : PAPER) * mix(1.0, shade, 0.5), mark, tint);
    base = mix(base, INK, max(wires.x, max(wires.y, wires.z)));
    base = mix(base, mark, max(lines.x, max(lines.y, lines.z)));
  } else if (mode == REFLECTION) {
    vec3 smoothed = normalize(normal);
    if (smoothed.z < 0.0) smoothed = -smoothed;
    vec3 mirrored = reflect(vec3(0.0, 0.0, -1.0), smoothed);
    // Not from the middle, where faces that look up or down would be on an edge of a stripe.
    float stripe = 0.8 + 8.0 * atan(mirrored.x, 1.0 + mirrored.z);
    float wave = sin(stripe);
    float width = max(fwidth(stripe), 1e-4);
    float dark = smoothstep(-width, width, wave);
    base = mix(vec3(0.98), vec3(0.08, 0.09, 0.12), mix(dark, 0.5, smoothstep(1.5, 3.5, width)));
    base = mix(base, base * shade, 0.25);
  }
  colour = vec4(base, 1.0);
}
