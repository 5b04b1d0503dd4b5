#version 300 es
precision highp float;
precision highp int;
precision highp isampler2D;
precision highp usampler2D;

// Of vertices: the position with the level of its energy, and the normal. Of faces: the corners,
// and in one number the levels of the dihedral angles at the sides and which sides are flipped.
uniform isampler2D positions;
uniform isampler2D normals;
uniform usampler2D faces;
// Rows: to the right, upwards, and towards the viewer.
uniform mat3 turn;
uniform vec3 target;
uniform vec2 zoom;

out vec3 normal;
out vec3 share;
out float energy;
flat out vec3 faceNormal;
flat out vec3 dihedral;
flat out vec3 flipped;

ivec2 texel(uint i) { return ivec2(i & 2047u, i >> 11); }

vec3 point(uint v) { return vec3(texelFetch(positions, texel(v), 0).xyz) / 32767.0; }

void main() {
  uvec4 face = texelFetch(faces, texel(uint(gl_VertexID / 3)), 0);
  int corner = gl_VertexID % 3;
  vec3 a = point(face.x), b = point(face.y), c = point(face.z);
  vec3 across = cross(b - a, c - a);
  faceNormal = turn * (dot(across, across) > 0.0 ? normalize(across) : vec3(0.0));
  share = vec3(corner == 0, corner == 1, corner == 2);
  uint v = face[corner];
  normal = turn * vec3(texelFetch(normals, texel(v), 0).xyz);
  energy = float(texelFetch(positions, texel(v), 0).w) / 255.0;
  uvec3 places = uvec3(0u, 8u, 16u);
  dihedral = vec3((uvec3(face.w) >> places) & 255u) / 255.0;
  flipped = vec3((uvec3(face.w) >> uvec3(24u, 25u, 26u)) & 1u);
  vec3 seen = turn * (point(v) - target);
  gl_Position = vec4(seen.xy * zoom, -seen.z / 4.0, 1.0);
}
