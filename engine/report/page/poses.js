// The links of one design at the poses that the file was asked for (engine/report/mechanism_section.cpp). Places are in
// mm, values of coordinates in SI.

/** One design at all stored poses. */
class Poses {
  constructor(packed) {
    Object.assign(this, packed);
    this.drawn = unpack(packed.drawn);
    this.reason = unpack(packed.reason);
    this.at = packed.at.map(unpack);
    const scale = shownScale("m");
    for (const column of this.at) for (let i = 0; i < column.length; ++i) column[i] *= scale;
    this.links = packed.links.map((link) => ({ ...link, radius: link.radius * shownScale("m") }));
    this.motions = packed.motions.map((motion) => ({ ...motion, coordinates: motion.coordinates.map(unpack) }));
    this.positions = packed.positions.map(unpack);
    this.conditioning = unpack(packed.conditioning);
    this.parts = [...new Set(packed.links.map((link) => link.part))];
    this.counts = packed.coordinates.map((c) => c.values.length);
    this.number = new Int32Array(this.reason.length).fill(-1); // among the drawn ones
    let count = 0;
    for (let pose = 0; pose < this.number.length; ++pose) if (this.drawn[pose]) this.number[pose] = count++;
  }
  /** Places of the sliders at a pose, and back. */
  places(pose) {
    const places = [];
    for (let c = this.counts.length - 1; c >= 0; pose = Math.floor(pose / this.counts[c--]))
      places.unshift(pose % this.counts[c]);
    return places;
  }
  pose(places) {
    return places.reduce((pose, place, c) => pose * this.counts[c] + place, 0);
  }
  values(places) {
    return places.map((place, c) => this.coordinates[c].values[place]);
  }
  /** Of the platform in the room, [x, y, z], for values of the coordinates; 0 where it has no such coordinate. */
  place(values) {
    return ["x", "y", "z"].map(
      (role) => shownScale("m") * (values[this.coordinates.findIndex((c) => c.role === role)] ?? 0),
    );
  }
  /** Where an end of links is at a pose, [x, y, z]. */
  end(pose, end) {
    return this.at.map((column) => column[Math.max(this.number[pose], 0) * this.ends + end]);
  }
  /** The links that can be drawn at a pose: all, or those of the frame where it does not assemble. */
  linksAt(pose) {
    const assembles = this.number[pose] >= 0;
    return this.links
      .filter((link) => assembles || link.part === "frame")
      .map((link) => ({ ...link, from: this.end(pose, link.from), to: this.end(pose, link.to) }));
  }
  /** What all poses together span, per axis. */
  span() {
    return this.at.map((column) => this.around(column));
  }
  /** What one pose spans. */
  spanAt(pose) {
    const first = Math.max(this.number[pose], 0) * this.ends;
    return this.at.map((column) => this.around(column.subarray(first, first + this.ends)));
  }
  around(places) {
    const radius = Math.max(...this.links.map((link) => link.radius));
    const [low, high] = rangeOf(places);
    return [low - 1.5 * radius, high + 1.5 * radius];
  }
}
