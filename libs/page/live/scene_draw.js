// WebGL 2: meshes by instances, one colour a material or a tag, shaded by the sun.

const kNone = 0xffffffff;

const kVertex = `#version 300 es
layout(location = 0) in vec3 cell;
layout(location = 1) in vec4 row0;
layout(location = 2) in vec4 row1;
layout(location = 3) in vec4 row2;
layout(location = 4) in uvec3 key;
uniform vec3 low, size;
uniform mat4 camera;
uniform uint material;
uniform bool byTag;
out vec3 place;
flat out uint shown;
void main() {
  vec4 local = vec4(low + size * cell, 1.0);
  place = vec3(dot(row0, local), dot(row1, local), dot(row2, local));
  shown = byTag ? key.y : key.x == 0xffffffffu ? material : key.x;
  gl_Position = camera * vec4(place, 1.0);
}`;

const kFragment = `#version 300 es
precision highp float;
in vec3 place;
flat in uint shown;
uniform vec3 sun, eye;
uniform uint chosen;
out vec4 colour;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  if (dot(normal, eye - place) < 0.0) normal = -normal;
  float light = 0.4 + 0.6 * (sun.z > 0.0 ? max(0.0, dot(normal, sun)) : 0.0);
  vec3 hue = vec3(1.0);
  if (shown != 0xffffffffu) {
    float h = fract(0.11 + 0.61803398875 * float(shown)) * 6.0;
    vec3 from = mod(h + vec3(6.0, 4.0, 2.0), 6.0);
    hue = (255.0 - 55.0 * float(shown % 3u)) / 255.0 * (0.15 + 0.85 * clamp(2.0 - min(from, 6.0 - from), 0.0, 1.0));
  }
  if (chosen != 0xfffffffeu && shown == chosen) hue = mix(hue, vec3(1.0, 0.2, 0.1), 0.5);
  colour = vec4(hue * light, 1.0);
}`;

// The same colour as text, of a material or a tag: that of live.js.
function colourOf(i) { return i === kNone || i < 0 ? '#fff' : `rgb(${classColour(i).map(Math.round).join(',')})`; }

class Painter {
  constructor(canvas) {
    this.gl = canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
    if (!this.gl) throw new Error('this browser has no WebGL 2');
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, kVertex], [gl.FRAGMENT_SHADER, kFragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    this.program = program;
    this.at = name => gl.getUniformLocation(program, name);
    this.things = [];
  }

  buffer(kind, data) {
    const gl = this.gl, buffer = gl.createBuffer();
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
  }

  add(thing) {
    const gl = this.gl;
    thing.array = gl.createVertexArray();
    gl.bindVertexArray(thing.array);
    this.buffer(gl.ARRAY_BUFFER, thing.cells);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 6, 0);
    this.buffer(gl.ARRAY_BUFFER, thing.places);
    for (let k = 0; k < 3; ++k) {
      gl.enableVertexAttribArray(1 + k);
      gl.vertexAttribPointer(1 + k, 4, gl.FLOAT, false, 48, 16 * k);
      gl.vertexAttribDivisor(1 + k, 1);
    }
    this.buffer(gl.ARRAY_BUFFER, thing.keys);
    gl.enableVertexAttribArray(4);
    gl.vertexAttribIPointer(4, 3, gl.UNSIGNED_INT, 12, 0);
    gl.vertexAttribDivisor(4, 1);
    this.buffer(gl.ELEMENT_ARRAY_BUFFER, thing.indices);
    this.things.push(thing);
  }

  draw(camera, sun, byTag, chosen) {
    const gl = this.gl, at = this.at;
    gl.viewport(0, 0, camera.width, camera.height);
    gl.clearColor(0.86, 0.9, 0.95, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(at('camera'), false, camera.matrix);
    gl.uniform3fv(at('sun'), sun);
    gl.uniform3fv(at('eye'), camera.eye);
    gl.uniform1i(at('byTag'), byTag ? 1 : 0);
    gl.uniform1ui(at('chosen'), chosen === null ? 0xfffffffe : chosen);
    for (const thing of this.things) {
      gl.bindVertexArray(thing.array);
      gl.uniform3fv(at('low'), thing.low);
      gl.uniform3fv(at('size'), thing.size);
      const wide = thing.indices.BYTES_PER_ELEMENT === 4;
      for (const [first, count, material] of thing.parts) {
        gl.uniform1ui(at('material'), material < 0 ? kNone : material);
        gl.drawElementsInstanced(gl.TRIANGLES, 3 * count, wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT,
          3 * first * thing.indices.BYTES_PER_ELEMENT, thing.places.length / 12);
      }
    }
  }
}
