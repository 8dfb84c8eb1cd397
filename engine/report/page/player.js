// Player of a motion: play and pause, speed, time slider, video recording.

const speeds = [0.1, 0.25, 0.5, 1, 2];

/** Adds a button. @param name  accessible name @param pressed  called on a click */
function button(parent, text, name, pressed) {
  const node = element("button", "", text);
  node.type = "button";
  node.setAttribute("aria-label", name);
  node.addEventListener("click", pressed);
  parent.append(node);
  return node;
}

/**
 * @param motions  motions of Poses
 * @param show     show(motion, k) shows the k-th pose of a motion
 * @param canvas   canvas() gives the canvas to record, or nothing if there is none
 * @returns { stop() }, which pauses at the current pose
 */
function addPlayer(parent, motions, show, canvas) {
  let time = 0,
    lastTick = null, // time stamp of the last frame [ms]; null while paused
    ended = null; // called at the end of the motion
  const motion = () => motions[selected.value];
  const sample = () => Math.round((time / motion().duration) * (motion().count - 1));
  const timeAt = (k) => (motion().duration * k) / (motion().count - 1);
  const stop = () => {
    lastTick = null;
    play.textContent = "▶ Play";
    play.setAttribute("aria-label", "play the motion");
  };
  const step = (tick) => {
    if (lastTick === null || !play.isConnected) return;
    time += ((tick - lastTick) / 1000) * speeds[speed.value];
    lastTick = tick;
    if (time >= motion().duration) {
      time %= motion().duration;
      ended?.();
    }
    if (sample() !== timeSlider.value) {
      timeSlider.set(sample());
      show(motion(), sample());
    }
    requestAnimationFrame(step);
  };
  const start = () => {
    lastTick = performance.now();
    play.textContent = "❚❚ Pause";
    play.setAttribute("aria-label", "pause the motion");
    requestAnimationFrame(step);
  };
  const selected =
    motions.length > 1
      ? choice(
          parent,
          "motion",
          motions.map((m) => m.name),
          0,
          () => show(motion(), sample()),
        )
      : { value: 0 };
  const play = button(parent, "▶ Play", "play the motion", () => (lastTick === null ? start() : stop()));
  const timeSlider = slider(
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
    button(parent, "● Record", "record the motion as a WebM video", ({ target }) => {
      const recorded = canvas();
      if (!recorded || target.disabled) return;
      const recorder = new MediaRecorder(recorded.captureStream(30), { mimeType: "video/webm" }),
        chunks = [];
      recorder.addEventListener("dataavailable", ({ data }) => chunks.push(data));
      recorder.addEventListener("stop", () => {
        const link = element("a");
        link.href = URL.createObjectURL(new Blob(chunks, { type: "video/webm" }));
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
