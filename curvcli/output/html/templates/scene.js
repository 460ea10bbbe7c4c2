const VERTEX = `
attribute float place; attribute float known; attribute vec3 across;
varying float vPlace; varying float vKnown; varying vec3 vAcross; varying vec3 vAt;
void main() {
  vPlace = place * known; vKnown = known; vAcross = normalMatrix * across;
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vAt = at.xyz;
  gl_Position = projectionMatrix * at;
}`;
// Values are interpolated, then coloured; undefined ones take no part, and the half of a face next to them is grey.
const FRAGMENT = `
uniform sampler2D map; uniform vec3 undefinedColor; uniform float smoothly; uniform float steps;
varying float vPlace; varying float vKnown; varying vec3 vAcross; varying vec3 vAt;
void main() {
  vec3 flatly = normalize(cross(dFdx(vAt), dFdy(vAt)));
  vec3 normal = smoothly > 0.5 && length(vAcross) > 0.3 ? normalize(vAcross) : flatly;
  float light = 0.6 + 0.4 * abs(dot(normal, normalize(vAt)));
  vec3 color = undefinedColor;
  if (vKnown >= 0.5) {
    float t = clamp(vPlace / vKnown, 0.0, 1.0);
    color = texture2D(map, vec2((floor(t * (steps - 1.0) + 0.5) + 0.5) / steps, 0.5)).rgb;
  }
  gl_FragColor = vec4(color * light, 1.0);
}`;
// A line of some pixels: each segment is a rectangle, widened on the screen and a little nearer to the eye than the faces.
const RIBBON = `
attribute vec3 from; attribute vec3 to; uniform vec2 pixels; uniform float width;
void main() {
  vec4 a = projectionMatrix * vec4((modelViewMatrix * vec4(from, 1.0)).xyz * 0.997, 1.0);
  vec4 b = projectionMatrix * vec4((modelViewMatrix * vec4(to, 1.0)).xyz * 0.997, 1.0);
  vec2 along = (b.xy / b.w - a.xy / a.w) * pixels;
  along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  vec4 at = mix(a, b, position.x);
  at.xy += (vec2(-along.y, along.x) * position.y + along * (2.0 * position.x - 1.0) * 0.5) * width / pixels * at.w;
  gl_Position = at;
}`;
const PLAIN = "uniform vec3 color; void main() { gl_FragColor = vec4(color, 1.0); }";
const RING = `
uniform vec3 color; uniform vec3 rim;
void main() {
  float r = length(gl_PointCoord - 0.5);
  if (r > 0.5 || r < 0.18) discard;
  gl_FragColor = vec4(r > 0.28 && r < 0.42 ? color : rim, 1.0);
}`;
const VIEWS = {
  iso: [[1, -1, 0.8165], [0, 0, 1]], front: [[0, -1, 0], [0, 0, 1]],
  right: [[1, 0, 0], [0, 0, 1]], top: [[0, 0, 1], [0, 1, 0]],
};
const FIELD = 35;

/**
 * Every corner of a face as far as half the shortest edge at its vertex, and the rest of the face: seven triangles with
 * corners of their own, and the vertex that colours each, -1 for none.
 */
function ownCells(positions, faces) {
  const at = (vertex) => [positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]];
  const reach = new Float32Array(positions.length / 3).fill(Infinity);
  const edges = (f) => [[faces[f], faces[f + 1]], [faces[f + 1], faces[f + 2]], [faces[f + 2], faces[f]]];
  const length = (a, b) => Math.hypot(...at(a).map((x, k) => at(b)[k] - x));
  for (let f = 0; f < faces.length; f += 3) {
    for (const [a, b] of edges(f)) for (const end of [a, b]) reach[end] = Math.min(reach[end], length(a, b));
  }
  const found = new Float32Array(21 * faces.length), owner = new Int32Array(7 * faces.length).fill(-1);
  for (let f = 0; f < faces.length; f += 3) {
    // Of each edge the points where the cell of its tail ends and that of its head begins.
    const rim = edges(f).flatMap(([a, b]) => {
      const full = length(a, b);
      return [[a, b], [b, a]].map(([from, towards]) => {
        const share = full > 0 ? Math.min(reach[from] / 2 / full, 0.5) : 0;
        return at(from).map((x, k) => x + share * (at(towards)[k] - x));
      });
    });
    const corners = [0, 1, 2].flatMap((k) => [at(faces[f + k]), rim[2 * k], rim[(2 * k + 5) % 6]]);
    for (let k = 0; k < 9; k++) owner[7 * f + k] = faces[f + Math.floor(k / 3)];
    const inner = [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5].map((k) => rim[k]);
    [...corners, ...inner].forEach((point, k) => found.set(point, 3 * (7 * f + k)));
  }
  return { positions: found, owner };
}

/** The surface on a canvas: turned by the trackball, drawn only when something changes. */
class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(FIELD, 1, 0.01, 100);
    this.controls = new THREE.TrackballControls(this.camera, canvas);
    Object.assign(this.controls, { staticMoving: true, rotateSpeed: 3, minDistance: 0.02, maxDistance: 30, keys: [] });
    this.renderer.debug.checkShaderErrors = false;
    this.ribbons = [];
    this.asked = true; // until everything is there
  }

  /** positions: (n, 3) within the unit ball; normals: (n, 3) int8; faces: (m, 3). */
  setSurface(positions, normals, faces) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("across", new THREE.BufferAttribute(normals, 3, true));
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    const n = positions.length / 3;
    for (const name of ["place", "known"]) {
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(n), 1));
    }
    this.uniforms = {
      map: { value: null }, undefinedColor: { value: new THREE.Color(0x808080) },
      smoothly: { value: 0 }, steps: { value: 1 },
    };
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide,
      extensions: { derivatives: true }, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.mesh = new THREE.Mesh(geometry, material);
    this.scene.add(this.mesh);
    this.geometry = geometry;
  }

  /** The faces cut into cells, drawn instead of them where the colour of a vertex is to stay in its surroundings. */
  cutCells() {
    const across = this.geometry.getAttribute("across").array;
    const { positions, owner } = ownCells(this.geometry.getAttribute("position").array, this.geometry.index.array);
    const geometry = new THREE.BufferGeometry(), n = owner.length, turned = new Int8Array(3 * n);
    for (let i = 0; i < n; i++) if (owner[i] >= 0) turned.set(across.subarray(3 * owner[i], 3 * owner[i] + 3), 3 * i);
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("across", new THREE.BufferAttribute(turned, 3, true));
    for (const name of ["place", "known"]) {
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(n), 1));
    }
    this.owner = owner;
    this.cells = new THREE.Mesh(geometry, this.mesh.material);
    this.cells.visible = false;
    this.scene.add(this.cells);
  }

  /** Give the cells the colours of their vertices, and what lies between them that of 0; zero: null to blend. */
  colorCells(place, known, zero) {
    if (zero !== null && !this.cells) this.cutCells();
    this.mesh.visible = zero === null;
    if (!this.cells) return;
    this.cells.visible = zero !== null;
    if (zero === null) return;
    const { array: places } = this.cells.geometry.getAttribute("place");
    const { array: knowns } = this.cells.geometry.getAttribute("known");
    this.owner.forEach((vertex, i) => {
      places[i] = vertex < 0 ? zero : place[vertex];
      knowns[i] = vertex < 0 ? 1 : known[vertex];
    });
    for (const name of ["place", "known"]) this.cells.geometry.getAttribute(name).needsUpdate = true;
  }

  /** place: (n,) where between the ends of the map; known: (n,) 1 or 0; map: (k, 3) bytes; grey: 3 bytes; zero: the
   * place of 0 where each vertex colours its own cell, null where colours are blended. */
  setColors(place, known, map, grey, zero = null) {
    this.colorCells(place, known, zero);
    for (const [name, array] of [["place", place], ["known", known]]) {
      const attribute = this.geometry.getAttribute(name);
      attribute.array.set(array);
      attribute.needsUpdate = true;
    }
    const steps = map.length / 3;
    const texels = new Uint8Array(steps * 4).fill(255);
    for (let i = 0; i < steps; i++) texels.set(map.subarray(3 * i, 3 * i + 3), 4 * i);
    this.uniforms.map.value?.dispose();
    const texture = new THREE.DataTexture(texels, steps, 1, THREE.RGBAFormat);
    texture.needsUpdate = true;
    this.uniforms.map.value = texture;
    this.uniforms.steps.value = steps;
    this.uniforms.undefinedColor.value.setRGB(...grey.map((part) => part / 255));
    this.draw();
  }

  /** Mark edges, given as pairs of vertices, by lines in a colour of the style sheet, or in one of 3 bytes. */
  addLines(pairs, variable, bytes = null) {
    if (!pairs.length) return;
    const position = this.geometry.getAttribute("position").array;
    const ends = [0, 1].map((end) => {
      const found = new Float32Array((pairs.length / 2) * 3);
      for (let i = end, to = 0; i < pairs.length; i += 2, to += 3) {
        for (let axis = 0; axis < 3; axis++) found[to + axis] = position[3 * pairs[i] + axis];
      }
      return new THREE.InstancedBufferAttribute(found, 3);
    });
    const corners = new Float32Array([0, -0.5, 0, 1, -0.5, 0, 1, 0.5, 0, 0, 0.5, 0]);
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.setAttribute("from", ends[0]);
    geometry.setAttribute("to", ends[1]);
    const uniforms = { pixels: { value: new THREE.Vector2(1, 1) }, width: { value: 3 }, color: { value: new THREE.Color() } };
    if (bytes) uniforms.color.value.setRGB(...bytes.map((part) => part / 255));
    const material = new THREE.ShaderMaterial({
      uniforms, vertexShader: RIBBON, fragmentShader: PLAIN, side: THREE.DoubleSide,
    });
    const lines = new THREE.Mesh(geometry, material);
    lines.frustumCulled = false;
    this.scene.add(lines);
    this.ribbons.push({ uniforms, variable });
  }

  showEdges(shown) {
    if (shown && !this.wire) {
      const material = new THREE.MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.35 });
      this.wire = new THREE.Mesh(this.geometry, material);
      this.scene.add(this.wire);
    }
    if (this.wire) this.wire.visible = shown;
    this.paint();
  }

  /** Put a ring at a vertex; it is seen through the surface. */
  mark(vertex) {
    const position = this.geometry.getAttribute("position").array;
    if (!this.ring) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3), 3));
      const uniforms = { color: { value: new THREE.Color(0xffd000) }, rim: { value: new THREE.Color(0x000000) } };
      const vertexShader = `uniform float size;
void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_PointSize = size; }`;
      uniforms.size = { value: 18 * this.renderer.getPixelRatio() };
      const material = new THREE.ShaderMaterial({
        uniforms, vertexShader, fragmentShader: RING, depthTest: false, transparent: true,
      });
      this.ring = new THREE.Points(geometry, material);
      this.ring.frustumCulled = false;
      this.ring.renderOrder = 1;
      this.scene.add(this.ring);
    }
    const at = this.ring.geometry.getAttribute("position");
    at.array.set(position.subarray(3 * vertex, 3 * vertex + 3));
    at.needsUpdate = true;
    this.draw();
  }

  /** The vertex under a point of the window, null where there is no surface: of the face hit, the nearest corner. */
  pick(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const point = new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    this.camera.updateMatrixWorld();
    ray.setFromCamera(point, this.camera);
    const hit = ray.intersectObject(this.mesh)[0];
    if (!hit) return null;
    const position = this.geometry.getAttribute("position");
    const distance = (i) => new THREE.Vector3().fromBufferAttribute(position, i).distanceToSquared(hit.point);
    return [hit.face.a, hit.face.b, hit.face.c].reduce((best, i) => (distance(i) < distance(best) ? i : best));
  }

  /** Look at the whole surface from a named side. */
  view(name) {
    const upright = ([x, y, z]) => (data.up === "y" ? [x, z, -y] : [x, y, z]);
    this.look(...VIEWS[name].map(upright));
  }

  /** Look at the whole surface from a direction. */
  look(direction, up) {
    const { aspect } = this.camera;
    const half = Math.min(FIELD / 2, (Math.atan(Math.tan((FIELD * Math.PI) / 360) * aspect) * 180) / Math.PI);
    const distance = 1.02 / Math.sin((half * Math.PI) / 180);
    this.controls.target.set(0, 0, 0);
    this.camera.up.set(...up);
    this.camera.position.set(...direction).setLength(distance);
    this.camera.lookAt(this.controls.target);
    this.draw();
  }

  /** Turn to where a vertex is in sight, keeping the distance. */
  face(vertex) {
    const normal = new THREE.Vector3().fromBufferAttribute(this.geometry.getAttribute("across"), vertex);
    const at = new THREE.Vector3().fromBufferAttribute(this.geometry.getAttribute("position"), vertex);
    const direction = normal.lengthSq() > 0 ? normal : at;
    if (direction.lengthSq() === 0) return;
    const eye = this.camera.position.clone().sub(this.controls.target);
    if (Math.abs(direction.clone().normalize().dot(this.camera.up)) > 0.99) this.camera.up.set(eye.y, eye.z, eye.x).normalize();
    this.camera.position.copy(this.controls.target).addScaledVector(direction.normalize(), eye.length());
    this.draw();
  }

  /** Turn by angles about the axes of the screen, as arrow keys do. */
  turn(right, up) {
    const eye = this.camera.position.clone().sub(this.controls.target);
    const side = new THREE.Vector3().crossVectors(this.camera.up, eye).normalize();
    const above = new THREE.Vector3().crossVectors(eye, side).normalize();
    for (const vector of [eye, this.camera.up]) vector.applyAxisAngle(above, right).applyAxisAngle(side, up);
    this.camera.position.copy(this.controls.target).add(eye);
    this.draw();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.draw();
  }

  /** Take colours from the style sheet, which knows light and dark. */
  paint() {
    const style = getComputedStyle(document.documentElement);
    const color = (variable) => new THREE.Color(style.getPropertyValue(variable).trim().slice(0, 7));
    for (const { uniforms, variable } of this.ribbons) if (variable) uniforms.color.value = color(variable);
    if (this.wire) this.wire.material.color = color("--ink");
    this.draw();
  }

  /** Fit the canvas to its place on the page; on paper it stays as it is. */
  resize() {
    if (matchMedia("print").matches) return;
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    for (const { uniforms } of this.ribbons) uniforms.pixels.value.set(width / 2, height / 2);
    this.controls.handleResize();
    if (!this.asked) this.now();
  }

  /** Draw with the next frame. */
  draw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.now());
  }

  now() {
    this.asked = false;
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }
}
