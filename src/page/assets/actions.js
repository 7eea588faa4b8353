// What people do: each is confirmed with a name, kept by the daemon, and can be undone.

const byId = (id) => document.getElementById(id);
const NAME = "rolltank.name";

async function post(path, body) {
  const answer = await fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  }).catch(() => null);
  if (answer === null) return { ok: false, told: "the daemon does not answer" };
  const told = await answer.text();
  return { ok: answer.ok, told: told.trim() };
}

// What each deed asks before it is done.
const DEEDS = {
  mark: () => ({ title: "Mark this instant", text: "A line in the strips and in the log.",
    why: "What happened", what: "mark" }),
  annotate: ({ run }) => ({ title: `Note on run ${run}`, text: "It stands beside the run in every report.",
    why: "Note", needsWhy: true, what: { annotate: { run } } }),
  reject: ({ run }) => ({ title: `Reject run ${run}`,
    text: "It leaves the damping law and the diagnosis, here and in every replay; it stays recorded.",
    why: "Why", needsWhy: true, what: { reject: { run } } }),
  accept: ({ run }) => ({ title: `Take run ${run} again`, text: "Undoes its rejection.",
    why: "Why", accept: run }),
  undo: ({ of }) => ({ title: `Undo number ${of}`, text: "A further line in the log; nothing is erased.",
    why: "Why", what: { undo: { of: Number(of) } } }),
  zero: () => ({ title: "Take zeros",
    text: "The model is upright and still, the rod unloaded. In force from the next rest on.",
    why: "Remark", zero: true }),
  record: () => (byId("recording").dataset.state === "bad"
    ? { title: "Start recording", text: "A new recording begins.", why: "Why", what: "start_recording" }
    : { title: "Stop recording",
      text: "Samples are still shown, but NOTHING is kept and no run is found until somebody starts it again.",
      why: "Why", what: "stop_recording" }),
};

export function wireActions(renew) {
  const dialog = byId("act");
  const form = dialog.querySelector("form");
  let deed = null;

  const act = (name, data = {}) => {
    if (dialog.open) return;
    deed = DEEDS[name](data);
    byId("act-title").textContent = deed.title;
    byId("act-text").textContent = deed.text;
    byId("act-why-label").textContent = deed.why;
    byId("act-why").value = "";
    byId("act-why").required = deed.needsWhy ?? false;
    byId("act-wrong").textContent = "";
    byId("act-by").value = localStorage.getItem(NAME) ?? "";
    const channel = byId("act-channel");
    channel.hidden = !deed.zero;
    const select = channel.querySelector("select");
    const quantities = [...document.querySelectorAll(".strip-head")]
      .map((head) => head.textContent.split(" ")[0]);
    select.replaceChildren(select.options[0], ...quantities.map((name) => new Option(name, name)));
    dialog.showModal();
    byId(byId("act-by").value ? "act-why" : "act-by").focus();
  };

  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const by = byId("act-by").value;
    const why = byId("act-why").value;
    localStorage.setItem(NAME, by);
    const { ok, told } = await send(deed, by, why, byId("act-channel").querySelector("select").value);
    if (!ok) {
      byId("act-wrong").textContent = told;
      return;
    }
    dialog.close();
    done(deed, told);
    renew();
  });
  byId("act-no").addEventListener("click", () => dialog.close());
  document.addEventListener("click", (event) => {
    const button = event.target.closest("button[data-act]");
    if (button) act(button.dataset.act, button.dataset);
  });

  // What can be undone is offered until it is closed or the next deed is told: no one is hurried.
  const place = byId("told");
  let leaving;
  const tell = (...what) => {
    place.dataset.shown = what.length ? "yes" : "no";
    place.replaceChildren(...what);
  };
  place.addEventListener("click", (event) => {
    if (event.target.matches(".close")) tell();
  });
  const done = ({ title }, told) => {
    clearTimeout(leaving);
    const text = document.createElement("span");
    text.textContent = `Done: ${title}. `;
    const number = /"number": (\d+)/.exec(told)?.[1];
    if (number === undefined) {
      tell(text);
      leaving = setTimeout(tell, 15000);
      return;
    }
    const undo = document.createElement("button");
    undo.type = "button";
    undo.dataset.act = "undo";
    undo.dataset.of = number;
    undo.textContent = "Undo";
    const close = document.createElement("button");
    close.type = "button";
    close.className = "close";
    close.textContent = "Close";
    tell(text, undo, " ", close);
  };
  return act;
}

async function send(deed, by, why, channel) {
  if (deed.zero) return post("/zero", { by, note: why, ...(channel ? { channel } : {}) });
  if (deed.accept) {
    const of = await rejectionOf(deed.accept);
    if (of === null) return { ok: false, told: "no rejection of this run stands" };
    return post("/act", { by, why, what: { undo: { of } } });
  }
  return post("/act", { by, why, what: deed.what });
}

async function rejectionOf(run) {
  const answer = await fetch("/judgements").catch(() => null);
  if (!answer?.ok) return null;
  const { judgements } = await answer.json();
  const standing = judgements.filter((one) => one.stands && one.judgement.what === "reject");
  return standing.findLast((one) => one.runs.includes(run))?.judgement.number ?? null;
}

// The token of a daemon that listens beyond its machine; a cookie that no script sees keeps it.
export function wireEntering(entered) {
  const dialog = byId("enter");
  dialog.addEventListener("cancel", (event) => event.preventDefault());
  dialog.querySelector("form").addEventListener("submit", async (event) => {
    event.preventDefault();
    const { ok, told } = await post("/enter", { token: byId("enter-token").value });
    byId("enter-token").value = "";
    byId("enter-wrong").textContent = ok ? "" : told;
    if (ok) {
      dialog.close();
      entered();
    }
  });
  return () => {
    if (!dialog.open) dialog.showModal();
  };
}
