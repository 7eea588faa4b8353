// Keys for whoever has wet hands and no mouse.

export function wireKeys({ act, help, toggleTheme }) {
  const views = [...document.querySelectorAll("nav button")];
  const keys = { m: () => act("mark"), z: () => act("zero"), r: () => act("record"),
    d: toggleTheme, "?": help };
  views.forEach((button, k) => {
    keys[String(k + 1)] = () => button.click();
  });
  document.addEventListener("keydown", (event) => {
    const isWriting = event.target.closest("input, select, textarea, dialog");
    if (isWriting || event.ctrlKey || event.altKey || event.metaKey) return;
    const key = keys[event.key];
    if (key) {
      event.preventDefault();
      key();
    }
  });
}
