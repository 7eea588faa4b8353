// The stream of events, taken up again whenever it breaks.

// The daemon sends something every half second; a longer silence is a break, told or not.
const SILENCE_MS = 2500;
const AGAIN_MS = 500;

export function listen(heard) {
  const badge = document.getElementById("link");
  let source = null;
  let last = performance.now();
  let bytes = 0;

  const tell = (connected) => {
    const words = connected ? "connected" : "no connection to the daemon";
    if (badge.textContent !== words) badge.textContent = words;
    badge.dataset.state = connected ? "good" : "bad";
    document.body.classList.toggle("stale", !connected);
  };

  const on = (name, take) => {
    source.addEventListener(name, (event) => {
      last = performance.now();
      bytes += event.data.length + name.length + 15;
      tell(true);
      take(JSON.parse(event.data));
    });
  };

  const open = () => {
    source?.close();
    source = new EventSource("/stream");
    last = performance.now();
    on("past", heard.past);
    on("strips", heard.strips);
    on("state", heard.state);
    source.onerror = () => {
      tell(false);
      // A browser tries again by itself only where it got no answer at all.
      if (source.readyState === EventSource.CLOSED) setTimeout(ask, AGAIN_MS);
    };
  };

  // Whether it is only the token that is missing.
  const ask = async () => {
    const answer = await fetch("/status").catch(() => null);
    if (answer?.status === 401) heard.locked();
    else if (answer?.ok) open();
    else setTimeout(ask, AGAIN_MS);
  };

  setInterval(() => {
    if (source?.readyState !== EventSource.CLOSED && performance.now() - last > SILENCE_MS) {
      tell(false);
      open();
    }
  }, 500);

  let since = performance.now();
  setInterval(() => {
    const now = performance.now();
    document.getElementById("figures").dataset.bytesPerS =
      Math.round((1000 * bytes) / (now - since));
    [since, bytes] = [now, 0];
  }, 2000);

  ask();
  return { again: open };
}
