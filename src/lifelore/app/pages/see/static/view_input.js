// Clicks and keys of both views.

/** Call back with the pixel of each click that was no drag. */
export function clicks(canvas, found) {
  let start = null;
  canvas.addEventListener("pointerdown", (event) => (start = [event.clientX, event.clientY]));
  canvas.addEventListener("pointerup", (event) => {
    if (start && Math.hypot(event.clientX - start[0], event.clientY - start[1]) < 5) {
      const box = canvas.getBoundingClientRect();
      found(event.clientX - box.left, event.clientY - box.top);
    }
    start = null;
  });
}

/** Let the keyboard turn, zoom and reset a view. */
export function keys(canvas, view) {
  const actions = {
    ArrowLeft: () => view.turn(-0.15, 0), ArrowRight: () => view.turn(0.15, 0),
    ArrowUp: () => view.turn(0, 0.1), ArrowDown: () => view.turn(0, -0.1),
    "+": () => view.zoom(0.87), "=": () => view.zoom(0.87), "-": () => view.zoom(1.15), 0: () => view.reset(),
  };
  canvas.addEventListener("keydown", (event) => {
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
}
