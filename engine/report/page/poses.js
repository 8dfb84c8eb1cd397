// Stored poses of one design: every combination of slider positions, then the samples of the motions
// (engine/report/mechanism_panel.cpp). Positions of link ends are in mm, values of coordinates in SI units.

/**
 * One design at all stored poses. Link ends, joint positions and conditioning are stored only for poses that assemble,
 * at assembledIndex[pose], which is -1 for the others.
 */
class Poses {
  constructor(packed) {
    Object.assign(this, packed);
    this.assembles = unpack(packed.assembles);
    this.reason_index = unpack(packed.reason_index);
    this.end_positions = packed.end_positions.map(unpack);
    const scale = shownScale("m");
    for (const column of this.end_positions) for (let i = 0; i < column.length; ++i) column[i] *= scale;
    this.links = packed.links.map((link) => ({ ...link, radius: link.radius * shownScale("m") }));
    this.motions = packed.motions.map((motion) => ({ ...motion, coordinates: motion.coordinates.map(unpack) }));
    this.joint_positions = packed.joint_positions.map(unpack);
    this.conditioning = unpack(packed.conditioning);
    this.parts = [...new Set(packed.links.map((link) => link.part))];
    this.counts = packed.coordinates.map((c) => c.values.length);
    this.assembledIndex = new Int32Array(this.reason_index.length).fill(-1);
    let count = 0;
    for (let pose = 0; pose < this.assembledIndex.length; ++pose)
      if (this.assembles[pose]) this.assembledIndex[pose] = count++;
  }
  /** Slider positions of a pose. */
  sliderPositions(pose) {
    const positions = [];
    for (let c = this.counts.length - 1; c >= 0; pose = Math.floor(pose / this.counts[c--]))
      positions.unshift(pose % this.counts[c]);
    return positions;
  }
  /** Number of the pose at given slider positions. */
  pose(positions) {
    return positions.reduce((pose, position, c) => pose * this.counts[c] + position, 0);
  }
  /** Values of the coordinates at given slider positions. */
  values(positions) {
    return positions.map((position, c) => this.coordinates[c].values[position]);
  }
  /** Position [x, y, z] of the platform for given values of the coordinates; 0 for missing coordinates. */
  position(values) {
    return ["x", "y", "z"].map(
      (role) => shownScale("m") * (values[this.coordinates.findIndex((c) => c.role === role)] ?? 0),
    );
  }
  /** Position [x, y, z] of a link end at a pose. */
  end(pose, end) {
    return this.end_positions.map((column) => column[Math.max(this.assembledIndex[pose], 0) * this.end_count + end]);
  }
  /** The links at a pose; only those of the frame if the pose does not assemble. */
  linksAt(pose) {
    const assembles = this.assembledIndex[pose] >= 0;
    return this.links
      .filter((link) => assembles || link.part === "frame")
      .map((link) => ({ ...link, from: this.end(pose, link.from), to: this.end(pose, link.to) }));
  }
  /** Range [low, high] of the links over all poses, per axis. */
  ranges() {
    return this.end_positions.map((column) => this.rangeWithRadius(column));
  }
  /** Range [low, high] of the links at one pose, per axis. */
  rangesAt(pose) {
    const first = Math.max(this.assembledIndex[pose], 0) * this.end_count;
    return this.end_positions.map((column) => this.rangeWithRadius(column.subarray(first, first + this.end_count)));
  }
  /** Range of link ends, extended by 1.5 times the largest link radius. */
  rangeWithRadius(values) {
    const radius = Math.max(...this.links.map((link) => link.radius));
    const [low, high] = rangeOf(values);
    return [low - 1.5 * radius, high + 1.5 * radius];
  }
}
