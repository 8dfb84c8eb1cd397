// Geometry of links, which are drawn as capsules: all points within a radius of a line segment.

/** Outline of a capsule projected along an axis: two half circles around its ends (one circle if they coincide). */
function capsuleOutline([x0, y0], [x1, y1], radius, points = 10) {
  const along = Math.atan2(y1 - y0, x1 - x0);
  const x = [],
    y = [];
  for (const [cx, cy, begin] of [
    [x0, y0, along + Math.PI / 2],
    [x1, y1, along - Math.PI / 2],
  ])
    for (let k = 0; k <= points; ++k) {
      const angle = begin + (Math.PI * k) / points;
      x.push(cx + radius * Math.cos(angle));
      y.push(cy + radius * Math.sin(angle));
    }
  x.push(x[0]);
  y.push(y[0]);
  return { x, y };
}

/** A unit vector perpendicular to a given unit vector. */
function perpendicular([x, y, z]) {
  const [a, b, c] = Math.abs(z) < 0.9 ? [-y, x, 0] : [0, -z, y];
  const length = Math.hypot(a, b, c) || 1;
  return [a / length, b / length, c / length];
}

/** Adds a triangulated capsule to a Plotly mesh { x, y, z, i, j, k, text }: rings of vertices from pole to pole. */
function addCapsule(mesh, from, to, radius, text, sides = 12) {
  const direction = to.map((value, c) => value - from[c]),
    length = Math.hypot(...direction);
  const axis = length > 1e-12 ? direction.map((value) => value / length) : [0, 0, 1];
  const u = perpendicular(axis),
    v = [axis[1] * u[2] - axis[2] * u[1], axis[2] * u[0] - axis[0] * u[2], axis[0] * u[1] - axis[1] * u[0]];
  const rings = [
    [from, -75],
    [from, -40],
    [from, 0],
    [to, 0],
    [to, 40],
    [to, 75],
  ];
  const first = mesh.x.length;
  for (const [centre, latitude] of rings) {
    const ringRadius = radius * Math.cos((latitude * Math.PI) / 180),
      offset = radius * Math.sin((latitude * Math.PI) / 180);
    for (let s = 0; s < sides; ++s) {
      const angle = (2 * Math.PI * s) / sides,
        cos = ringRadius * Math.cos(angle),
        sin = ringRadius * Math.sin(angle);
      ["x", "y", "z"].forEach((name, c) => mesh[name].push(centre[c] + offset * axis[c] + cos * u[c] + sin * v[c]));
      mesh.text.push(text);
    }
  }
  const poles = [
    [from, -1, 0],
    [to, 1, rings.length - 1],
  ].map(([centre, side, ring]) => {
    ["x", "y", "z"].forEach((name, c) => mesh[name].push(centre[c] + side * radius * axis[c]));
    mesh.text.push(text);
    return [mesh.x.length - 1, first + ring * sides];
  });
  for (let ring = 0; ring + 1 < rings.length; ++ring)
    for (let s = 0; s < sides; ++s) {
      const a = first + ring * sides + s,
        b = first + ring * sides + ((s + 1) % sides);
      mesh.i.push(a, b);
      mesh.j.push(b, b + sides);
      mesh.k.push(a + sides, a + sides);
    }
  for (const [pole, ring] of poles)
    for (let s = 0; s < sides; ++s) {
      mesh.i.push(pole);
      mesh.j.push(ring + s);
      mesh.k.push(ring + ((s + 1) % sides));
    }
}
