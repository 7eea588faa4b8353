// What was learnt: parts of the page that the daemon writes, fetched whenever there is more.

const LINKS = /^run-|^index\.html$|^diagnosis\.html$/;

export class Views {
  constructor(strips) {
    this.strips = strips;
    this.parts = {};
    this.shown = null;
    this.judged = null;
    this.view = "now";
  }

  show(name) {
    this.view = name;
    this.strips.shown = name === "now";
    this.strips.ask();
    this.place();
  }

  hear({ shown, judgements, recording, sessions }) {
    if (shown !== this.shown) {
      this.shown = shown;
      this.renew();
    }
    if (judgements !== this.judged || recording !== this.recording) {
      [this.judged, this.recording] = [judgements, recording];
      this.renewLog();
    }
    this.sessions = sessions;
  }

  async renew() {
    const answer = await fetch("/view").catch(() => null);
    if (!answer?.ok) return;
    this.parts = (await answer.json()).parts;
    this.place();
  }

  // Only the view that is looked at is in the page: the report's figures share their names.
  place() {
    for (const part of document.querySelectorAll(".part[data-part]")) {
      const isSeen = part.closest("section").dataset.of === this.view;
      const html = isSeen ? (this.parts[part.dataset.part] ?? "") : "";
      if (part.placed === html) continue;
      part.placed = html;
      part.innerHTML = html;
      for (const link of part.querySelectorAll("a[href]")) {
        const href = link.getAttribute("href");
        if (LINKS.test(href)) link.setAttribute("href", `/results/${href}`);
      }
    }
  }

  async renewLog() {
    const answer = await fetch("/judgements").catch(() => null);
    if (!answer?.ok) return;
    const { judgements } = await answer.json();
    const standing = judgements.filter((one) => one.stands).map((one) => one.judgement);
    this.strips.marks = standing
      .filter((one) => one.what === "mark" && one.recording === this.recording)
      .map((one) => one.time_s);
    document.getElementById("log").replaceChildren(...judgements.reverse().map(line));
    if (judgements.length === 0) {
      document.getElementById("log").textContent = "Nobody has judged anything yet.";
    }
  }
}

const WORDS = { mark: "marked", annotate: "noted", reject: "rejected", zero: "took zeros of",
  stop_recording: "stopped recording", start_recording: "started recording", undo: "undid" };

function line({ judgement, stands }) {
  const row = document.createElement("p");
  row.className = stands ? "judgement" : "judgement undone";
  row.dataset.number = judgement.number;
  const { what, run, of, time_s: timeS, channels } = judgement;
  const about = run ? ` ${run.recording} ${run.start_s.toFixed(1)} to ${run.end_s.toFixed(1)} s`
    : what === "mark" ? ` ${timeS.toFixed(2)} s of ${judgement.recording || "no recording"}`
    : what === "undo" ? ` number ${of}`
    : channels ? ` ${channels.map((channel) => channel.quantity).join(" and ")}` : "";
  const why = judgement.why ? `: ${judgement.why}` : "";
  const text = document.createElement("span");
  text.textContent = `${judgement.number}. ${judgement.at} ${judgement.by} ${WORDS[what]}${about}${why}`
    + (stands ? "" : " (undone)");
  row.append(text);
  if (stands) {
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.act = "undo";
    button.dataset.of = judgement.number;
    button.textContent = "Undo";
    button.setAttribute("aria-label", `Undo number ${judgement.number}`);
    row.append(button);
  }
  return row;
}
