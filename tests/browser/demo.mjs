// The demo's day at the page: from the first sample until its daemon has ended.
import { assert, connected, open, show, story } from "./stage.mjs";

await story(async (browser) => {
  const page = await open(browser);
  await connected(page);
  await page.waitForSelector("#strips canvas");
  const seen = { doing: new Set(), conditions: new Set(), runs: 0, damping: "" };
  const look = () => page.evaluate(() => ({
    isOver: document.querySelector("#link").dataset.state === "bad",
    doing: document.querySelector("#doing").textContent,
    condition: document.querySelector("#condition").textContent,
    rows: document.querySelectorAll("#damping-at-speeds tbody tr").length,
    damping: document.querySelector("#damping-at-speeds tbody")?.innerText ?? "",
  }));
  await show(page, "damping");
  for (let overFor = 0; overFor < 20;) {
    const { isOver, doing, condition, rows, damping } = await look();
    // A session that gives way to the next is no end.
    overFor = isOver ? overFor + 1 : 0;
    seen.doing.add(doing.split(/[ ,:]/)[0]);
    seen.conditions.add(condition);
    seen.runs = Math.max(seen.runs, rows);
    seen.damping = damping || seen.damping;
    await page.waitForTimeout(200);
  }
  assert.deepEqual([...seen.conditions].sort(), ["bare hull", "bilge keels"]);
  assert(seen.doing.has("the") && seen.doing.has("waiting"), [...seen.doing].join());
  assert(seen.runs >= 8, `only ${seen.runs} rows of damping`);
  // Damping at Fr 0.2 with its interval, one click from the first page.
  assert.match(seen.damping, /0\.(199|200|201)\s+\d\.\d+\s+\[\d\.\d+, \d\.\d+\]/);
  assert.deepEqual(page.complaints, [], "console");
});
