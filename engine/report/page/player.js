// Playing along a motion: play and pause, speed, a slider over the time, and a film of one run.

const speeds = [0.1, 0.25, 0.5, 1, 2];

function button(parent, text, name, pressed) {
  const node = element("button", "", text);
  node.type = "button";
  node.setAttribute("aria-label", name);
  node.addEventListener("click", pressed);
  parent.append(node);
  return node;
}

/**
 * @param motions  of a design's Poses
 * @param show     (motion, k) shows its k-th pose
 * @param canvas   () the one to film; null: nothing can be filmed now
 * @returns { stop() }, which leaves the picture where it is
 */
function addPlayer(parent, motions, show, canvas) {
  let time = 0,
    last = null, // of the clock; null while it stands still
    ended = null; // called at the end of a run
  const motion = () => motions[which.value];
  const sample = () => Math.round((time / motion().duration) * (motion().count - 1));
  const timeAt = (k) => (motion().duration * k) / (motion().count - 1);
  const stop = () => {
    last = null;
    play.textContent = "▶ Play";
    play.setAttribute("aria-label", "play the motion");
  };
  const step = (clock) => {
    if (last === null || !play.isConnected) return;
    time += ((clock - last) / 1000) * speeds[speed.value];
    last = clock;
    if (time >= motion().duration) {
      time %= motion().duration;
      ended?.();
    }
    if (sample() !== scrub.value) {
      scrub.set(sample());
      show(motion(), sample());
    }
    requestAnimationFrame(step);
  };
  const start = () => {
    last = performance.now();
    play.textContent = "❚❚ Pause";
    play.setAttribute("aria-label", "pause the motion");
    requestAnimationFrame(step);
  };
  const which =
    motions.length > 1
      ? choice(
          parent,
          "motion",
          motions.map((m) => m.name),
          0,
          () => show(motion(), sample()),
        )
      : { value: 0 };
  const play = button(parent, "▶ Play", "play the motion", () => (last === null ? start() : stop()));
  const scrub = slider(
    parent,
    motions.length > 1 ? "time" : motions[0].name,
    motions[0].count,
    0,
    (k) => digits(timeAt(k), 3) + " s",
    (k) => {
      stop();
      time = timeAt(k);
      show(motion(), k);
    },
  );
  const speed = choice(
    parent,
    "speed",
    speeds.map((s) => s + " ×"),
    speeds.indexOf(1),
    () => {},
  );
  if (globalThis.MediaRecorder && HTMLCanvasElement.prototype.captureStream)
    button(parent, "● Record", "record one run of the motion as WebM", ({ target }) => {
      const filmed = canvas();
      if (!filmed || target.disabled) return;
      const recorder = new MediaRecorder(filmed.captureStream(30), { mimeType: "video/webm" }),
        parts = [];
      recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
      recorder.addEventListener("stop", () => {
        const link = element("a");
        link.href = URL.createObjectURL(new Blob(parts, { type: "video/webm" }));
        link.download = motion().name.replace(/[^\w-]+/g, "-") + ".webm";
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60000);
        target.disabled = false;
      });
      target.disabled = true;
      ended = () => {
        ended = null;
        stop();
        recorder.stop();
      };
      time = 0;
      recorder.start();
      start();
    });
  return { stop };
}
