// The page: which view is shown, and who hears of what the stream tells.
import { listen } from "./stream.js";
import { Strips } from "./strips.js";
import { showState } from "./state.js";
import { Views } from "./views.js";
import { wireActions, wireEntering } from "./actions.js";
import { wireKeys } from "./keys.js";

const strips = new Strips(document.getElementById("strips"));
const views = new Views(strips);

function showView(name) {
  for (const button of document.querySelectorAll("nav button")) {
    if (button.dataset.view === name) button.setAttribute("aria-current", "page");
    else button.removeAttribute("aria-current");
  }
  for (const section of document.querySelectorAll("main > section")) {
    section.hidden = section.dataset.of !== name;
  }
  views.show(name);
}

for (const button of document.querySelectorAll("nav button")) {
  button.addEventListener("click", () => {
    showView(button.dataset.view);
    history.replaceState(null, "", `#${button.dataset.view}`);
  });
}

const toggleTheme = () => document.dispatchEvent(new Event("toggle-theme"));
document.getElementById("theme").addEventListener("click", toggleTheme);
const help = () => document.getElementById("keys").showModal();
document.getElementById("help").addEventListener("click", help);

const act = wireActions(() => views.renew());
wireKeys({ act, help, toggleTheme });

const named = location.hash.slice(1);
const known = document.querySelector(`nav button[data-view="${CSS.escape(named)}"]`);
showView(known ? named : "now");

const stream = listen({
  state: (state) => {
    showState(state);
    strips.name(state.channels, state.recording);
    views.hear(state);
  },
  past: (past) => strips.begin(past),
  strips: (more) => strips.push(more),
  locked: () => entering(),
});
const entering = wireEntering(() => stream.again());
