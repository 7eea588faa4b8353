// The state in words: what the tank is doing, its channels, its alarms.

const byId = (id) => document.getElementById(id);

// Only what has changed is written, so that a screen reader is not told the same again.
function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export function showState(state) {
  say(byId("campaign"), state.campaign);
  say(byId("condition"), state.condition);
  document.title = state.alarms.length > 0 ? `ALARM – ${state.campaign}` : state.campaign;
  const recording = byId("recording");
  const stopped = state.paused_by !== null;
  say(recording, stopped ? "not recorded" : `recording ${state.recording.split("/").at(-1)}`);
  recording.dataset.state = stopped ? "bad" : "good";
  say(byId("record"), stopped ? "Start recording" : "Stop recording");
  say(byId("doing"), state.doing);
  byId("doing").dataset.rest = state.at_rest;
  say(byId("so-far"), state.provisional ?? "");
  byId("provisional").hidden = state.provisional === null;
  showAlarms(state.alarms);
  showHealth(state);
  showCarriage(state);
}

function showAlarms(alarms) {
  const place = byId("alarms");
  const told = JSON.stringify(alarms);
  if (place.dataset.told === told) return;
  place.dataset.told = told;
  place.replaceChildren(...alarms.map(({ severe, text, hint }) => {
    const line = document.createElement("p");
    line.className = severe ? "alarm" : "warning";
    const what = document.createElement("strong");
    what.textContent = `${severe ? "ALARM" : "Note"}: ${text}`;
    line.append(what, ` – ${hint}`);
    return line;
  }));
}

function showHealth({ channels, links }) {
  const body = document.querySelector("#health tbody");
  while (body.rows.length > channels.length) body.deleteRow(-1);
  channels.forEach((channel, k) => {
    const row = body.rows[k] ?? body.insertRow();
    while (row.cells.length < 6) row.insertCell();
    const link = links.find((link) => link.name === channel.device);
    const [name, state, clock, samples, lost, damaged] = row.cells;
    say(name, `${channel.quantity} · ${channel.device}`);
    const quality = channel.quality.length > 0 ? channel.quality.join(", ") : "good";
    const words = !channel.linked ? "not linked" : channel.silent ? "silent" : quality;
    say(state, `${words === "good" ? "✓" : "✕"} ${words}`);
    state.dataset.state = words === "good" ? "good" : "bad";
    state.title = link?.identity ?? link?.port ?? "";
    say(clock, channel.bound_s === null ? "–" : `${(1000 * channel.bound_s).toFixed(2)} ms`);
    say(samples, String(channel.received));
    say(lost, String(channel.lost));
    say(damaged, String(channel.damaged + channel.over_range + channel.repeated));
  });
}

function showCarriage({ pass, tank_length_m: length, froude }) {
  const speed = `${pass.speed_m_s.toFixed(3)} m/s${froude === null ? "" : ` (Fr ${froude.toFixed(3)})`}`;
  const way = `${Math.abs(pass.way_m).toFixed(1)} m${length === null ? "" : ` of ${length} m`}`;
  const words = pass.moves ? `${speed}, ${way} into the pass` : `standing; last pass ${way}`;
  say(byId("carriage"), words);
  const bar = byId("way");
  bar.setAttribute("aria-label", `Way of the carriage: ${words}`);
  bar.hidden = length === null;
  const share = length === null ? 0 : Math.min(1, Math.abs(pass.way_m) / length);
  bar.firstElementChild.style.width = `${100 * share}%`;
}
