// Dark or light before anything is drawn: as the system wants it, until somebody chooses.
(() => {
  "use strict";
  const KEY = "rolltank.theme";
  const system = window.matchMedia("(prefers-color-scheme: dark)");
  const wanted = () => localStorage.getItem(KEY) ?? (system.matches ? "dark" : "light");
  const show = () => {
    document.documentElement.dataset.theme = wanted();
    document.dispatchEvent(new Event("theme"));
  };
  show();
  system.addEventListener("change", show);
  document.addEventListener("toggle-theme", () => {
    localStorage.setItem(KEY, wanted() === "dark" ? "light" : "dark");
    show();
  });
})();
