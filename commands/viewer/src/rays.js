// Where a straight line meets triangles: what a click hits.

/**
 * The first hit of a ray.
 * @param points Float32Array, 3 a point  @param triangles Uint32Array, 3 points a triangle
 * @param reach only hits with from < distance, in lengths of the direction  @return {triangle, distance}, or null
 */
export function firstHit(points, triangles, origin, direction, from = 0, reach = Infinity) {
  const [ox, oy, oz] = origin, [dx, dy, dz] = direction;
  let best = null, nearest = reach;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const det = ux * px + uy * py + uz * pz;
    if (det === 0) continue;
    const sx = ox - points[a], sy = oy - points[a + 1], sz = oz - points[a + 2];
    const r = (sx * px + sy * py + sz * pz) / det;
    if (r < -1e-6 || r > 1 + 1e-6) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const s = (dx * qx + dy * qy + dz * qz) / det;
    if (s < -1e-6 || r + s > 1 + 1e-6) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / det;
    if (distance > from && distance < nearest) {
      nearest = distance;
      best = {triangle: t / 3, distance};
    }
  }
  return best;
}
