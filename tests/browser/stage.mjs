// The stage of every story: Chromium, pages whose every error counts, and a line to the story.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import readline from "node:readline";

// The packages lie below target/, from where the story is run.
const require = createRequire(`${process.cwd()}/`);
const { chromium } = require("playwright-core");
const AXE = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

export const [address, ...rest] = process.argv.slice(2);
export const VIEWS = ["now", "last-run", "damping", "runs", "plan", "diagnosis", "log"];

const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];
// The machine may be busy with every other story.
export const PATIENCE = { timeout: 60_000 };

const lines = readline.createInterface({ input: process.stdin })[Symbol.asyncIterator]();

// Asks the story to do something in the tank; its answer when it is done.
export async function ask(what) {
  console.log(`ask ${what}`);
  const { value } = await lines.next();
  return value;
}

export const launch = () =>
  chromium.launch({ executablePath: process.env.CHROMIUM, args: FLAGS, headless: true });

// A page with what it complained about; while the daemon is away, the browser itself complains.
export async function open(browser, options = {}, where = `http://${address}/`) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  page.complaints = [];
  page.on("console", (message) => {
    const isAway = /ERR_CONNECTION_REFUSED|ERR_INCOMPLETE_CHUNKED_ENCODING|ERR_CONNECTION_RESET/;
    if (["error", "warning"].includes(message.type()) && !isAway.test(message.text())) {
      page.complaints.push(message.text());
    }
  });
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  await page.goto(where);
  return page;
}

// What is serious or critical for people who do not see, hear or point as others do.
export async function unfit(page) {
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => window.axe.run());
  return violations.filter(({ impact }) => ["serious", "critical"].includes(impact))
    .map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map((node) => node.html).join(" | ")}`);
}

export const show = (page, view) => page.click(`nav button[data-view="${view}"]`);

export async function connected(page) {
  await page.waitForFunction(() => document.querySelector("#link").dataset.state === "good",
    null, PATIENCE);
}

// Runs a story to its end; what fails in it fails the test with its own words.
export async function story(play) {
  const browser = await launch();
  try {
    await play(browser);
  } finally {
    await browser.close();
  }
  console.log("done");
  process.exit(0);
}

export { assert };
