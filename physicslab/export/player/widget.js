// The page of a run in a frame; its time and its play button are traits of the widget.
export default {
  render({ model, el }) {
    const names = ["time", "playing"], send = state => frame.contentWindow?.postMessage(state, "*");
    el.innerHTML = model.get("frame");
    const frame = el.firstElementChild;
    frame.onload = () => send(Object.fromEntries(names.map(name => [name, model.get(name)])));
    let told = {};  // what came from the frame does not go back to it, which has moved on since
    const hear = ({ source, data }) => {
      if (source !== frame.contentWindow) return;
      told = data;
      for (const name of names) model.set(name, data[name]);
      model.save_changes();
    };
    const passers = names.map(name => [`change:${name}`, () => {
      if (model.get(name) !== told[name]) send({ [name]: model.get(name) });
    }]);
    for (const [change, pass] of passers) model.on(change, pass);
    addEventListener("message", hear);
    return () => {
      for (const [change, pass] of passers) model.off(change, pass);
      removeEventListener("message", hear);
    };
  },
};
