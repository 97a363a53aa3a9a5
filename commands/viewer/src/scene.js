// The deformed bodies and their skins in 3D, by vtk.js: one actor with its edges for each surface.
import "@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry";
import vtkDataArray from "@kitware/vtk.js/Common/Core/DataArray";
import vtkPolyData from "@kitware/vtk.js/Common/DataModel/PolyData";
import vtkInteractorStyleManipulator from "@kitware/vtk.js/Interaction/Style/InteractorStyleManipulator";
import vtkMousePan from "@kitware/vtk.js/Interaction/Manipulators/MouseCameraTrackballPanManipulator";
import vtkMouseRotate from "@kitware/vtk.js/Interaction/Manipulators/MouseCameraTrackballRotateManipulator";
import vtkMouseZoom from "@kitware/vtk.js/Interaction/Manipulators/MouseCameraTrackballZoomManipulator";
import vtkGestureCamera from "@kitware/vtk.js/Interaction/Manipulators/GestureCameraManipulator";
import vtkActor from "@kitware/vtk.js/Rendering/Core/Actor";
import vtkColorTransferFunction from "@kitware/vtk.js/Rendering/Core/ColorTransferFunction";
import vtkMapper from "@kitware/vtk.js/Rendering/Core/Mapper";
import vtkRenderer from "@kitware/vtk.js/Rendering/Core/Renderer";
import vtkRenderWindow from "@kitware/vtk.js/Rendering/Core/RenderWindow";
import vtkRenderWindowInteractor from "@kitware/vtk.js/Rendering/Core/RenderWindowInteractor";
import vtkOpenGLRenderWindow from "@kitware/vtk.js/Rendering/OpenGL/RenderWindow";
import {mat4, vec3} from "gl-matrix";

import {at, maps, statuses} from "./colours.js";
import {array, study} from "./data.js";
import {firstHit} from "./rays.js";

const plain = [0.72, 0.75, 0.79]; // what has no value
const highlight = {patch: [0.0, 0.0, 0.0], masters: [0.8, 0.47, 0.65]};
const ribbon = 0.006; // width of a skin in the plane, in sizes of the model

const corners = [0, 1, 2, 0, 2, 3]; // of both triangles of a face of four

/** Faces of three and four points as cells of vtk and as triangles, with the facet that each belongs to. */
async function faces(meta) {
  const [tri, triFacet, quad, quadFacet] = await Promise.all([meta.triangles, meta.triangle_facets, meta.quads, meta.quad_facets].map(array));
  const n = tri.length / 3, m = quad.length / 4;
  const cells = new Uint32Array(4 * n + 5 * m), triangles = new Uint32Array(tri.length + 6 * m);
  const facets = new Int32Array(n + m), facetOfTriangle = new Int32Array(n + 2 * m);
  for (let i = 0, c = 0; i < tri.length; i += 3) {
    cells[c++] = 3;
    for (let k = 0; k < 3; ++k) cells[c++] = tri[i + k];
  }
  triangles.set(tri);
  facets.set(triFacet);
  facetOfTriangle.set(triFacet);
  for (let i = 0; i < m; ++i) {
    const cell = 4 * n + 5 * i, halves = tri.length + 6 * i;
    cells[cell] = 4;
    for (let k = 0; k < 4; ++k) cells[cell + 1 + k] = quad[4 * i + k];
    for (let k = 0; k < 6; ++k) triangles[halves + k] = quad[4 * i + corners[k]];
    facets[n + i] = facetOfTriangle[n + 2 * i] = facetOfTriangle[n + 2 * i + 1] = quadFacet[i];
  }
  return {cells, triangles, facets, facetOfTriangle, source: null};
}

/** Segments of a skin in the plane as ribbons: points of their own, each from a node. */
async function ribbons(meta) {
  const [ends, of] = await Promise.all([meta.segments, meta.segment_facets].map(array));
  const n = ends.length / 2;
  const cells = new Uint32Array(5 * n), triangles = new Uint32Array(6 * n), source = new Uint32Array(4 * n);
  const facetOfTriangle = new Int32Array(2 * n);
  for (let i = 0; i < n; ++i) {
    const p = 4 * i;
    cells.set([4, p, p + 1, p + 2, p + 3], 5 * i);
    triangles.set([p, p + 1, p + 2, p, p + 2, p + 3], 6 * i);
    source.set([ends[2 * i], ends[2 * i + 1], ends[2 * i + 1], ends[2 * i]], p);
    facetOfTriangle[2 * i] = facetOfTriangle[2 * i + 1] = of[i];
  }
  return {cells, triangles, facets: of, facetOfTriangle, source, ends};
}

function makeActor(polydata, mapper) {
  mapper.setInputData(polydata);
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  return actor;
}

export class Scene {
  /** @param box the element that holds the canvas */
  static async create(box) {
    const scene = new Scene();
    scene.flat = study.dimension === 2;
    const read = Promise.all([study.points, study.nodes, study.facet_cells, study.facet_patches].map(array));
    for (const meta of study.surfaces) for (const what of Object.values(meta)) if (what?.type) array(what);
    scene.size = study.size;
    scene.lut = vtkColorTransferFunction.newInstance();
    scene.book = {zone: -1, opening: 0};
    scene.marks = [];
    scene.see = {opacity: 1, edges: true, hidden: new Set()};
    scene.openWindow(box); // takes long; what is read is inflated meanwhile
    [scene.initial, scene.nodes, scene.facetCell, scene.facetPatch] = await read;
    scene.points = Float32Array.from(scene.initial);
    scene.surfaces = await Promise.all(study.surfaces.map((meta) => scene.makeSurface(meta)));
    return scene;
  }

  openWindow(box) {
    this.box = box;
    this.renderer = vtkRenderer.newInstance();
    this.window = vtkRenderWindow.newInstance();
    this.window.addRenderer(this.renderer);
    this.view = vtkOpenGLRenderWindow.newInstance();
    this.view.setContainer(box);
    this.window.addView(this.view);
    const interactor = vtkRenderWindowInteractor.newInstance();
    interactor.setView(this.view);
    interactor.initialize();
    interactor.bindEvents(box);
    const style = vtkInteractorStyleManipulator.newInstance();
    const turn = this.flat ? vtkMousePan.newInstance({button: 1}) : vtkMouseRotate.newInstance({button: 1});
    for (const manipulator of [turn, vtkMousePan.newInstance({button: 1, shift: true}), vtkMousePan.newInstance({button: 2}),
      vtkMouseZoom.newInstance({button: 3}), vtkMouseZoom.newInstance({scrollEnabled: true, dragEnabled: false})])
      style.addMouseManipulator(manipulator);
    if (!this.flat) style.addGestureManipulator(vtkGestureCamera.newInstance());
    interactor.setInteractorStyle(style);
    this.style = style;
    this.interactor = interactor;
    this.renderer.getActiveCamera().setParallelProjection(true);
    new ResizeObserver(() => this.resize()).observe(box);
  }

  resize() {
    const {width, height} = this.box.getBoundingClientRect();
    if (!width || !height) return;
    const ratio = window.devicePixelRatio || 1;
    this.view.setSize(Math.floor(width * ratio), Math.floor(height * ratio));
    this.render();
  }

  async makeSurface(meta) {
    const own = meta.segments ? await ribbons(meta) : await faces(meta);
    const coordinates = own.source ? new Float32Array(3 * own.source.length) : this.points;
    const polydata = vtkPolyData.newInstance();
    polydata.getPoints().setData(coordinates, 3);
    polydata.getPolys().setData(own.cells);
    const mapper = vtkMapper.newInstance({interpolateScalarsBeforeMapping: true, useLookupTableScalarRange: true, lookupTable: this.lut});
    const actor = makeActor(polydata, mapper);
    mapper.setResolveCoincidentTopologyToPolygonOffset();
    mapper.setRelativeCoincidentTopologyPolygonOffsetParameters(1, 2);
    const look = actor.getProperty();
    look.setColor(...plain);
    look.setAmbient(this.flat ? 1 : 0.62);
    look.setDiffuse(this.flat ? 0 : 0.42);
    look.setLighting(!this.flat);
    this.renderer.addActor(actor);
    const surface = {meta, ...own, polydata, mapper, actor, coordinates};
    if (meta.edges) surface.edges = await this.makeEdges(meta);
    return surface;
  }

  async makeEdges(meta) {
    const ends = await array(meta.edges);
    const lines = new Uint32Array(1.5 * ends.length);
    for (let i = 0, l = 0; i < ends.length; i += 2) {
      lines[l++] = 2;
      lines[l++] = ends[i];
      lines[l++] = ends[i + 1];
    }
    const polydata = vtkPolyData.newInstance();
    polydata.getPoints().setData(this.points, 3);
    polydata.getLines().setData(lines);
    const actor = makeActor(polydata, vtkMapper.newInstance({scalarVisibility: false}));
    actor.getProperty().setLighting(false);
    actor.setPickable(false);
    this.renderer.addActor(actor);
    return {polydata, actor};
  }

  /** @param displacement components of DEPL, or null  @param scale of it */
  deform(displacement, scale) {
    const {points, initial} = this;
    points.set(initial);
    const parts = displacement ?? [];
    for (let c = 0; c < parts.length; ++c)
      for (let i = 0, p = c; p < points.length; ++i, p += 3) if (parts[c][i] === parts[c][i]) points[p] += scale * parts[c][i];
    for (const surface of this.surfaces) {
      if (surface.source) this.layRibbons(surface);
      for (const shown of [surface, surface.edges])
        if (shown) {
          shown.polydata.getPoints().modified();
          shown.polydata.modified();
        }
    }
    this.placeBook();
  }

  /** In the plane a skin lies along its body, inside it: its normal points to the right of its segments. */
  layRibbons({ends, coordinates}) {
    const {points} = this;
    const width = ribbon * this.size, lift = 1e-4 * this.size;
    for (let i = 0; i < ends.length / 2; ++i) {
      const a = 3 * ends[2 * i], b = 3 * ends[2 * i + 1], p = 12 * i;
      const dx = points[b] - points[a], dy = points[b + 1] - points[a + 1];
      const along = width / (Math.hypot(dx, dy) || 1), nx = -dy * along, ny = dx * along;
      coordinates.set([points[a], points[a + 1], lift, points[b], points[b + 1], lift, points[b] + nx, points[b + 1] + ny, lift,
        points[a] + nx, points[a + 1] + ny, lift], p);
    }
  }

  /**
   * Colour all surfaces.
   * @param kind "node", "facet" or "patch": what the values belong to  @param values Float32Array, or null: no colours
   */
  colour(kind, values) {
    for (const surface of this.surfaces) {
      const {polydata, mapper, source, facets, meta} = surface;
      polydata.getPointData().setScalars(null);
      polydata.getCellData().setScalars(null);
      const has = values && (kind !== "patch" || meta.kind === "slave");
      mapper.setScalarVisibility(Boolean(has));
      if (has && kind === "node") {
        const own = source ? Float32Array.from(source, (node) => values[node]) : values;
        polydata.getPointData().setScalars(vtkDataArray.newInstance({name: "values", values: own}));
        mapper.setScalarModeToUsePointData();
      } else if (has) {
        const of = kind === "patch" ? (f) => values[this.facetPatch[f]] : (f) => values[f];
        polydata.getCellData().setScalars(vtkDataArray.newInstance({name: "values", values: Float32Array.from(facets, of)}));
        mapper.setScalarModeToUseCellData();
      }
      mapper.setInterpolateScalarsBeforeMapping(kind === "node");
      polydata.modified();
    }
    this.contactOnly = kind === "patch" && values !== null;
    this.applyLook();
  }

  /** What a value looks like. @param map name of a colour map, or "status" */
  setMap(map, [low, high]) {
    const {lut} = this;
    lut.removeAllPoints();
    if (map === "status") {
      for (const {value, colour} of statuses) {
        lut.addRGBPoint(value - 0.499, ...colour);
        lut.addRGBPoint(value + 0.499, ...colour);
      }
    } else {
      const list = maps[map], top = high > low ? high : low + 1;
      list.forEach((_, i) => lut.addRGBPoint(low + ((top - low) * i) / (list.length - 1), ...at(map, i / (list.length - 1))));
    }
    lut.setNanColor(...plain, 1);
    lut.setMappingRange(...(map === "status" ? [-1.499, 1.499] : [low, high > low ? high : low + 1]));
    lut.updateRange();
  }

  setTheme({background, ink}) {
    this.renderer.setBackground(...background);
    for (const {edges} of this.surfaces) edges?.actor.getProperty().setColor(...ink);
    this.applyLook();
  }

  /** Opacity, edges and visibility of each surface. */
  applyLook() {
    const open = this.book.zone >= 0 && this.book.opening > 0;
    for (const surface of this.surfaces) {
      const {meta, actor, edges} = surface;
      const isBody = meta.kind === "body";
      const of = open ? meta.zone === this.book.zone : !this.see.hidden.has(meta.part) || (!isBody && this.contactOnly && meta.kind === "slave");
      const visible = (surface.shown = of && !(open && isBody));
      const opacity = isBody || (this.contactOnly && meta.kind === "master" && !open) ? this.see.opacity : 1;
      actor.setVisibility(visible && opacity > 0);
      actor.getProperty().setOpacity(opacity);
      if (edges) {
        edges.actor.setVisibility(visible && this.see.edges);
        edges.actor.getProperty().setOpacity(this.flat ? 0.25 : Math.max(0.12, 0.4 * opacity));
      }
    }
    for (const {actor, surface} of this.marks) actor.setVisibility(surface.shown);
  }

  // ------------------------------------------------------------------------------------------------ the open book

  /** Both skins of a zone apart, so that the surfaces that face each other are seen. @param opening from 0 (in place) to 1 */
  openBook(zone, opening) {
    const moves = zone !== this.book.zone || opening > 0 !== this.book.opening > 0;
    this.book = {zone, opening};
    this.placeBook();
    this.applyLook();
    if (moves) this.fit();
  }

  placeBook() {
    const {zone, opening} = this.book;
    const pages = {};
    for (const surface of this.surfaces) if (surface.meta.zone === zone) pages[surface.meta.kind] = surface;
    const turns = zone >= 0 && opening > 0 && pages.slave && pages.master ? this.turnsOf(pages, opening) : {};
    for (const surface of this.surfaces) {
      const matrix = surface.meta.zone === zone ? turns[surface.meta.kind] : undefined;
      for (const actor of [surface.actor, surface.edges?.actor]) actor?.setUserMatrix(matrix ?? mat4.identity(new Float64Array(16)));
      surface.turn = matrix;
    }
  }

  /** The mean normal and the middle of a surface, its bounds. */
  shapeOf({triangles, coordinates, ends}) {
    const normal = vec3.create(), middle = vec3.create(), u = vec3.create(), v = vec3.create();
    let whole = 0;
    const corner = (i) => coordinates.subarray(3 * i, 3 * i + 3);
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [corner(triangles[t]), corner(triangles[t + 1]), corner(triangles[t + 2])];
      const n = vec3.cross(vec3.create(), vec3.sub(u, b, a), vec3.sub(v, c, a));
      const area = vec3.length(n);
      vec3.add(normal, normal, n);
      for (const p of [a, b, c]) vec3.scaleAndAdd(middle, middle, p, area / 3);
      whole += area;
    }
    vec3.scale(middle, middle, 1 / (whole || 1));
    if (ends) this.planeNormal(ends, normal);
    const directed = vec3.length(normal) / (whole || 1);
    return {middle, normal: vec3.normalize(normal, normal), directed: ends ? 1 : directed};
  }

  planeNormal(ends, normal) {
    vec3.zero(normal);
    for (let i = 0; i < ends.length / 2; ++i) {
      const a = 3 * ends[2 * i], b = 3 * ends[2 * i + 1];
      normal[0] += this.points[b + 1] - this.points[a + 1];
      normal[1] -= this.points[b] - this.points[a];
    }
  }

  /** How far a surface reaches along a direction: [least, most]. */
  reach({triangles, coordinates}, direction) {
    let least = Infinity, most = -Infinity;
    for (const i of triangles) {
      const x = coordinates[3 * i] * direction[0] + coordinates[3 * i + 1] * direction[1] + coordinates[3 * i + 2] * direction[2];
      least = Math.min(least, x);
      most = Math.max(most, x);
    }
    return [least, most];
  }

  /** The matrices of both pages: each turns about a spine between them; in the plane, and where a skin closes in itself, they part without turning. */
  turnsOf({slave, master}, opening) {
    const page = this.shapeOf(slave), other = this.shapeOf(master);
    const apart = (surface, way) => mat4.fromTranslation(new Float64Array(16), vec3.scale(vec3.create(), surface, way));
    if (this.flat) {
      const way = 0.5 * opening * 0.25 * this.size;
      return {slave: apart(page.normal, -way), master: apart(page.normal, way)};
    }
    // across the pages: the direction in them that is shortest, so that the book stays compact
    const up = Math.abs(page.normal[2]) < 0.9 ? [0, 0, 1] : [0, 1, 0];
    let spine = vec3.normalize(vec3.create(), vec3.cross(vec3.create(), page.normal, up));
    let across = vec3.cross(vec3.create(), spine, page.normal);
    const length = (d) => Math.max(...[slave, master].map((s) => this.reach(s, d)).map(([a, b]) => b - a));
    if (length(across) > length(spine)) [spine, across] = [across, vec3.negate(vec3.create(), spine)];
    const [first, last] = [Math.min(this.reach(slave, across)[0], this.reach(master, across)[0]),
      Math.max(this.reach(slave, across)[1], this.reach(master, across)[1])];
    if (page.directed < 0.2 || other.directed < 0.2) {
      const way = 0.55 * opening * (last - first);
      return {slave: apart(across, -way), master: apart(across, way)};
    }
    this.book.spine = spine;
    // the spine lies at the end of both pages; the slave turns to one side, the master to the other
    const spot = vec3.scaleAndAdd(vec3.create(), page.middle, across, last + 0.02 * (last - first) - vec3.dot(page.middle, across));
    const turn = (angle) => {
      const m = mat4.fromTranslation(new Float64Array(16), spot);
      mat4.rotate(m, m, angle, spine);
      return mat4.translate(m, m, vec3.negate(vec3.create(), spot));
    };
    const quarter = (opening * Math.PI) / 2;
    const side = this.openedSide(page.normal, spine, across);
    return {slave: turn(-side * quarter), master: turn(side * quarter)};
  }

  /** The sense in which the slave's normal turns away from the spine. */
  openedSide(normal, spine, across) {
    const turned = vec3.cross(vec3.create(), spine, normal);
    return vec3.dot(turned, across) > 0 ? 1 : -1;
  }

  // ------------------------------------------------------------------------------------------------ camera

  render() {
    if (this.hold) return;
    this.renderer.resetCameraClippingRange();
    this.window.render();
  }

  /** All that is shown, seen from where one looks from now. */
  fit() {
    if (this.book.zone >= 0 && this.book.opening > 0 && !this.flat) this.facePages();
    const camera = this.renderer.getActiveCamera();
    const towards = camera.getDirectionOfProjection(), up = camera.getViewUp();
    const right = vec3.normalize(vec3.create(), vec3.cross(vec3.create(), towards, up));
    const above = vec3.cross(vec3.create(), right, towards);
    const axes = [right, above, towards];
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const {actor, coordinates, triangles, turn} of this.surfaces) {
      if (!actor.getVisibility()) continue;
      // the turn belongs to the axes: points are many
      axes.forEach((axis, k) => {
        const [x, y, z] = turn ? [0, 4, 8].map((c) => turn[c] * axis[0] + turn[c + 1] * axis[1] + turn[c + 2] * axis[2]) : axis;
        const shift = turn ? turn[12] * axis[0] + turn[13] * axis[1] + turn[14] * axis[2] : 0;
        let least = Infinity, most = -Infinity;
        for (let t = 0; t < triangles.length; ++t) {
          const p = 3 * triangles[t], at = x * coordinates[p] + y * coordinates[p + 1] + z * coordinates[p + 2];
          if (at < least) least = at;
          if (at > most) most = at;
        }
        low[k] = Math.min(low[k], least + shift);
        high[k] = Math.max(high[k], most + shift);
      });
    }
    if (low[0] > high[0]) return;
    low[1] -= 0.2 * (high[1] - low[1]); // there stands the scale
    const focus = vec3.create();
    axes.forEach((axis, k) => vec3.scaleAndAdd(focus, focus, axis, (low[k] + high[k]) / 2));
    camera.setFocalPoint(...focus);
    camera.setPosition(...vec3.scaleAndAdd(vec3.create(), focus, towards, -3 * this.size));
    const [width, height] = this.view.getSize();
    camera.setParallelScale(0.56 * Math.max(high[1] - low[1], ((high[0] - low[0]) * height) / width) || 1);
    this.render();
  }

  /** Look at the open pages from where their faces are seen. */
  facePages() {
    const slave = this.surfaces.find(({meta}) => meta.zone === this.book.zone && meta.kind === "slave");
    const master = this.surfaces.find(({meta}) => meta.zone === this.book.zone && meta.kind === "master");
    if (!slave?.turn || !master?.turn) return;
    const seen = vec3.create(), part = vec3.create();
    for (const page of [slave, master]) {
      const direction = this.shapeOf(page).normal;
      const m = page.turn; // columns
      for (let r = 0; r < 3; ++r) part[r] = m[r] * direction[0] + m[4 + r] * direction[1] + m[8 + r] * direction[2];
      vec3.add(seen, seen, part);
    }
    if (vec3.length(seen) < 1e-3) return;
    this.lookFrom(vec3.normalize(seen, seen), this.book.spine ?? (Math.abs(seen[2]) > 0.9 ? [0, 1, 0] : [0, 0, 1]));
  }

  lookFrom(direction, up) {
    const camera = this.renderer.getActiveCamera();
    const focus = camera.getFocalPoint();
    camera.setPosition(...focus.map((x, i) => x + this.size * 3 * direction[i]));
    camera.setViewUp(...up);
    this.renderer.resetCameraClippingRange();
  }

  lookAlong(name) {
    const ways = {x: [[1, 0, 0], [0, 0, 1]], y: [[0, -1, 0], [0, 0, 1]], z: [[0, 0, 1], [0, 1, 0]], "3D": [[-0.55, -0.7, 0.45], [0, 0, 1]]};
    this.lookFrom(...ways[this.flat ? "z" : name]);
    this.fit();
  }

  /** Turn (in the plane: move) by degrees to the right and up. */
  turn(right, up) {
    const camera = this.renderer.getActiveCamera();
    if (this.flat) {
      const step = (0.02 * camera.getParallelScale()) / 10;
      const move = [step * right, step * up, 0];
      camera.setFocalPoint(...camera.getFocalPoint().map((x, i) => x + move[i]));
      camera.setPosition(...camera.getPosition().map((x, i) => x + move[i]));
    } else {
      camera.azimuth(-right);
      camera.elevation(-up);
      camera.orthogonalizeViewUp();
    }
    this.render();
  }

  zoom(factor) {
    const camera = this.renderer.getActiveCamera();
    camera.setParallelScale(camera.getParallelScale() / factor);
    this.render();
  }

  // ------------------------------------------------------------------------------------------------ picking

  /** What lies under a place of the box, in CSS pixels: {surface, facet, point}, or null. */
  pick(x, y) {
    const {width, height} = this.box.getBoundingClientRect();
    const place = [(x / width) * 2 - 1, 1 - (y / height) * 2];
    const camera = this.renderer.getActiveCamera();
    const inverse = mat4.invert(mat4.create(), mat4.transpose(mat4.create(), camera.getCompositeProjectionMatrix(width / height, -1, 1)));
    const near = vec3.transformMat4(vec3.create(), [...place, -1], inverse);
    const far = vec3.transformMat4(vec3.create(), [...place, 1], inverse);
    let best = null;
    for (const surface of this.surfaces) {
      if (!surface.actor.getVisibility()) continue;
      if (surface.meta.kind !== "slave" && this.see.opacity < 0.6 && this.contactOnly && !surface.turn) continue; // seen through
      let [from, to] = [near, far];
      if (surface.turn) {
        const back = mat4.invert(mat4.create(), surface.turn);
        [from, to] = [near, far].map((p) => vec3.transformMat4(vec3.create(), p, back));
      }
      const way = vec3.sub(vec3.create(), to, from);
      const hit = firstHit(surface.coordinates, surface.triangles, from, way, 0, best?.distance ?? 1);
      if (hit) best = {surface, facet: surface.facetOfTriangle[hit.triangle], triangle: hit.triangle, distance: hit.distance,
        point: vec3.scaleAndAdd(vec3.create(), from, way, hit.distance)};
    }
    return best;
  }

  /** The node of a picked triangle that is nearest to the point. */
  nodeAt({surface, triangle, point}) {
    const corners = [...surface.triangles.subarray(3 * triangle, 3 * triangle + 3)];
    const away = (i) => vec3.distance(surface.coordinates.subarray(3 * i, 3 * i + 3), point);
    const nearest = corners.reduce((a, b) => (away(b) < away(a) ? b : a));
    return surface.source ? surface.source[nearest] : nearest;
  }

  /** The facets of the master skin of a zone that lie on some of its cells. @param cells numbers from 1 on  @return a Set */
  facetsOf(cells, zone) {
    const skin = this.surfaces.find(({meta}) => meta.zone === zone && meta.kind === "master"), wanted = new Set(cells);
    return new Set([...(skin?.facets ?? [])].filter((facet) => wanted.has(this.facetCell[facet])));
  }

  /** Outline facets: a patch and its masters. @param groups [{facets: Set, kind}] */
  mark(groups) {
    for (const {actor} of this.marks) this.renderer.removeActor(actor);
    this.marks = [];
    for (const {wanted, kind} of groups)
      for (const surface of this.surfaces) {
        const lines = surface.meta.kind === "body" && wanted.onSkins ? [] : this.outline(surface, wanted.facets);
        if (!lines.length) continue;
        const polydata = vtkPolyData.newInstance();
        polydata.getPoints().setData(surface.coordinates, 3);
        polydata.getLines().setData(Uint32Array.from(lines));
        const actor = makeActor(polydata, vtkMapper.newInstance({scalarVisibility: false}));
        actor.getMapper().setRelativeCoincidentTopologyLineOffsetParameters(-4, -4);
        actor.getProperty().setLighting(false);
        actor.getProperty().setLineWidth(kind === "patch" ? 4 : 3);
        actor.getProperty().setColor(...(kind === "patch" ? this.ink ?? highlight.patch : highlight.masters));
        actor.setPickable(false);
        if (surface.turn) actor.setUserMatrix(surface.turn);
        actor.setVisibility(surface.shown);
        this.renderer.addActor(actor);
        this.marks.push({actor, surface});
      }
  }

  /** The sides of faces of some facets that only one of these faces has. */
  outline({triangles, facetOfTriangle}, wanted) {
    const sides = new Map();
    for (let t = 0; t < facetOfTriangle.length; ++t) {
      if (!wanted.has(facetOfTriangle[t])) continue;
      for (let k = 0; k < 3; ++k) {
        const a = triangles[3 * t + k], b = triangles[3 * t + ((k + 1) % 3)];
        const key = a < b ? `${a} ${b}` : `${b} ${a}`;
        sides.set(key, sides.has(key) ? null : [2, a, b]);
      }
    }
    return [...sides.values()].filter(Boolean).flat();
  }
}
