// A day at the page: from the first sample to judged runs, through a pulled cable and a restart.
import { VIEWS, address, ask, assert, connected, open, PATIENCE, show, story, unfit }
  from "./stage.mjs";

await story(async (browser) => {
  const page = await open(browser, { colorScheme: "light" });
  await connected(page);

  await chartsMove(page);
  const delay = await runAppears(page);
  console.log(`a run is on the page ${delay.toFixed(0)} ms after its end`);
  assert(delay < 1000, `a run took ${delay} ms to appear`);
  await numbersAreTheJsons(page);

  const second = await open(browser, { viewport: { width: 820, height: 1180 } });
  await connected(second);
  await chartsMove(second);

  await rejectAndUndo(page, second);
  await cableIsPulled(page, second);
  await keysWork(page);

  await page.evaluate(() => {
    window.breaks = 0;
    const badge = document.querySelector("#link");
    new MutationObserver(() => {
      window.breaks += badge.dataset.state === "bad" ? 1 : 0;
    }).observe(badge, { attributeFilter: ["data-state"] });
  });
  await ask("restart");
  await connected(page);
  assert(await page.evaluate(() => window.breaks) > 0, "the page did not say that it was cut off");
  await connected(second);
  await show(page, "now");
  await chartsMove(page);
  await show(page, "runs");
  // What earlier recordings hold is read anew beside the runs that are made meanwhile.
  const judged = page.locator("[data-part=runs]", { hasText: "rejected by hand by C. Costa" });
  await judged.waitFor(PATIENCE);
  // Only now: on a clock eight times as fast, a second recording is dated ahead of the restart.
  await show(page, "now");
  await recordingStopsAndStarts(page);

  const reports = await reportsAreFit(browser, page);
  await page.evaluate(() => document.dispatchEvent(new Event("toggle-theme")));
  const bad = reports;
  for (const theme of ["dark", "light"]) {
    for (const view of VIEWS) {
      await show(page, view);
      await page.waitForTimeout(50);
      bad.push(...(await unfit(page)).map((told) => `${view}, ${theme}: ${told}`));
    }
    await page.evaluate(() => document.dispatchEvent(new Event("toggle-theme")));
  }
  assert.deepEqual(bad, [], "axe");
  assert.deepEqual([...page.complaints, ...second.complaints], [], "console");
});

// The report's own pages, as the daemon serves them, in light and dark.
async function reportsAreFit(browser, page) {
  const { runs: [run] } = await identified(page);
  const bad = [];
  for (const colorScheme of ["light", "dark"]) {
    const report = await open(browser, { colorScheme }, `http://${address}/results/index.html`);
    const ground = await report.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(ground === "rgb(255, 255, 255)", colorScheme === "light", ground);
    for (const name of ["index.html", "diagnosis.html", `run-${run}.html`]) {
      await report.goto(`http://${address}/results/${name}`);
      assert(await report.locator("h1").count() === 1, name);
      bad.push(...(await unfit(report)).map((told) => `${name}, ${colorScheme}: ${told}`));
    }
    assert.deepEqual(report.complaints, [], "console of the report");
    await report.context().close();
  }
  return bad;
}

function alarms(page) {
  return page.locator("#alarms .alarm");
}

async function chartsMove(page) {
  const picture = () => page.evaluate(() =>
    [...document.querySelectorAll("#strips canvas")].map((canvas) => canvas.toDataURL()).join());
  await page.waitForSelector("#strips canvas", PATIENCE);
  const before = await picture();
  await page.waitForTimeout(400);
  const after = await picture();
  assert.notEqual(before, after, "the charts stand still");
  const [roll, speed] = await page.locator(".strip-head").allTextContents();
  assert.match(roll, /^roll -?[\d.]+ deg$/);
  assert.match(speed, /^speed -?[\d.]+ m\/s$/);
}

// From the sample by which a run is known to have ended to its row.
async function runAppears(page) {
  await show(page, "runs");
  return page.evaluate(async () => {
    const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
    const found = async () => (await (await fetch("/status")).json()).runs.n_found;
    const rows = () => document.querySelectorAll("#runs-table tbody tr").length;
    const [before, rowsBefore] = [await found(), rows()];
    while (await found() === before) await wait(10);
    const ended = performance.now();
    while (rows() === rowsBefore) await wait(5);
    return performance.now() - ended;
  });
}

// What is shown, within half of its last digit.
async function numbersAreTheJsons(page) {
  let rows, results;
  // A run may end between a look at the page and one at the results.
  await until("the runs of the page in the results", async () => {
    rows = await page.$$eval("#runs-table tbody tr", (rows) => rows.map((row) =>
      [row.cells[0].textContent, row.cells[5].textContent.replaceAll("\u2212", "-")]));
    results = await page.evaluate(async () =>
      (await fetch("/results/identification.json")).json());
    return rows.every(([id]) => results.runs.some((run) => run.id === id));
  });
  assert(rows.length > 0);
  for (const [id, shown] of rows) {
    const { b1_per_s: b1 } = results.runs.find((run) => run.id === id);
    const numbers = shown.match(/-?\d+\.?\d*/g);
    assert.equal(numbers.length, 3, shown);
    [b1.mean, b1.lo95, b1.hi95].forEach((wanted, k) => {
      const digits = numbers[k].split(".")[1]?.length ?? 0;
      assert(Math.abs(wanted - Number(numbers[k])) <= 0.5001 * 10 ** -digits, `${shown}: ${wanted}`);
    });
  }
  // Three clicks from the first page are allowed, and one is enough.
  await show(page, "now");
  await show(page, "damping");
  const damping = await page.textContent("#damping-at-speeds tbody");
  assert.match(damping, /0\.000\s*0\.\d+ \[0\.\d+, 0\.\d+\]/);
}

async function confirm(page, why) {
  await page.fill("#act-by", "C. Costa");
  await page.fill("#act-why", why);
  await page.click("#act-yes");
  await page.waitForSelector("#act:not([open])", { state: "attached", ...PATIENCE });
}

function identified(page) {
  return page.evaluate(async () => {
    const results = await (await fetch("/results/identification.json")).json();
    return { runs: results.runs.map((run) => run.id),
      byHand: results.rejected.filter((one) => one.run).map(({ run, reason }) => [run, reason]) };
  });
}

async function until(what, isSo) {
  for (let k = 0; k < 600; k += 1) {
    if (await isSo()) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  assert.fail(`never ${what}`);
}

// Whatever the page would do after ten seconds or more, it does at once.
function hurry() {
  const real = window.setTimeout;
  window.setTimeout = (then, ms, ...rest) => real(then, ms < 10_000 ? ms : 0, ...rest);
  window.slowDown = () => { window.setTimeout = real; };
}

async function rejectAndUndo(page, second) {
  await show(page, "runs");
  const id = await page.locator("#runs-table tbody tr td.name").last().textContent();
  const reject = () => page.click(`button[data-act=reject][data-run="${id}"]`);
  await reject();
  await page.fill("#act-by", "C. Costa");
  await page.click("#act-yes");
  assert(await page.isVisible("#act"), "a rejection needs a reason");
  await page.evaluate(hurry);
  await confirm(page, "a hand touched the model");
  await page.waitForSelector(`button[data-act=accept][data-run="${id}"]`, PATIENCE);
  await page.waitForTimeout(300);
  assert(await page.isVisible("#told button[data-act=undo]"), "the offer to undo did not wait");
  await page.evaluate(() => window.slowDown());
  await until("rejected in the file", async () => (await identified(page)).byHand.length === 1);
  const { runs, byHand } = await identified(page);
  assert(!runs.includes(id));
  assert.equal(byHand[0][0], id);
  assert.match(byHand[0][1],
    /^rejected by hand by C\. Costa, \d{4}-\d\d-\d\d [\d:]{8} UTC: a hand touched the model$/);
  const own = await page.context().newPage();
  const ownSays = async () => {
    await own.goto(`http://${address}/results/run-${id}.html`);
    return own.textContent("#judged");
  };
  assert((await ownSays()).startsWith(`This run is ${byHand[0][1]}`), await ownSays());
  await show(second, "runs");
  await second.waitForSelector(`button[data-act=accept][data-run="${id}"]`, PATIENCE);

  await page.click("#told button[data-act=undo]");
  await confirm(page, "it was a gust");
  await page.waitForSelector(`button[data-act=reject][data-run="${id}"]`, PATIENCE);
  await until("taken again in the file", async () => (await identified(page)).runs.includes(id));
  await until("taken again on its page", async () => (await ownSays()) === "");

  // An undo is a judgement like any other.
  await page.click("#told button[data-act=undo]");
  await confirm(page, "no gust");
  await page.waitForSelector(`button[data-act=accept][data-run="${id}"]`, PATIENCE);
  await until("rejected again", async () => (await identified(page)).byHand.length === 1);
  await until("rejected again on its page", async () => (await ownSays()).includes("C. Costa"));
  await show(page, "log");
  await page.click("#log .judgement:not(.undone):has-text('undid number 2') button");
  await confirm(page, "a gust after all");
  await until("taken once more", async () => (await identified(page)).runs.includes(id));
  await own.close();
  await show(page, "runs");

  await page.click(`button[data-act=annotate][data-run="${id}"]`);
  await confirm(page, "door open");
  await reject();
  await confirm(page, "a hand after all");
  await page.click(`button[data-act=accept][data-run="${id}"]`);
  await confirm(page, "no hand");
  await page.waitForSelector(`button[data-act=reject][data-run="${id}"]`, PATIENCE);
  await reject();
  await confirm(page, "wave maker ran");
  await until("rejected for good", async () => (await identified(page)).byHand.length === 1);
  await show(page, "log");
  await page.waitForFunction(() =>
    document.querySelectorAll("#log .judgement").length === 8, null, PATIENCE);
  // The offer to undo waits, however slow the machine, until somebody is done with it.
  await page.click("#told button.close");
  assert.equal(await page.textContent("#told"), "");
}

async function cableIsPulled(page, second) {
  await show(page, "now");
  // An instrument whose thread waits for a processor is silent for a while, and that is told too.
  await until("nothing is alarming", async () => await alarms(page).count() === 0);
  const seen = page.evaluate(async () => {
    while (!document.querySelector("#alarms")?.textContent.includes("potentiometer")) {
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
    return performance.timeOrigin + performance.now();
  });
  const pulled = Number(await ask("unplug"));
  const delay = (await seen) - pulled;
  console.log(`a pulled cable alarms after ${delay.toFixed(0)} ms`);
  assert(delay < 1000, `the alarm took ${delay} ms`);
  assert.match(await page.textContent("#alarms"), /ALARM: potentiometer/);
  assert.match(await page.title(), /^ALARM/);
  await alarms(second).first().waitFor(PATIENCE);
  assert.deepEqual(await unfit(page), [], "axe with an alarm");
  await ask("replug");
  await page.waitForFunction(() => !document.querySelector("#alarms .alarm"), null, PATIENCE);
}

async function recordingStopsAndStarts(page) {
  await page.click("#record");
  await confirm(page, "lunch");
  await alarms(page).filter({ hasText: "C. Costa stopped the recording" }).waitFor(PATIENCE);
  await page.waitForSelector("#recording[data-state=bad]", PATIENCE);
  await chartsMove(page);
  assert.equal(await page.textContent("#record"), "Start recording");
  await page.click("#record");
  await confirm(page, "back again");
  await page.waitForSelector("#recording[data-state=good]", PATIENCE);
}

async function keysWork(page) {
  await page.keyboard.press("?");
  assert(await page.isVisible("#keys"));
  assert.deepEqual(await unfit(page), [], "axe with the keys");
  await page.keyboard.press("Escape");
  await page.keyboard.press("7");
  assert(await page.isVisible("#log"));
  await page.keyboard.press("m");
  assert.deepEqual(await unfit(page), [], "axe with a question");
  await confirm(page, "door");
  await page.locator("#log .judgement", { hasText: "marked" }).waitFor(PATIENCE);
  await page.keyboard.press("5");
  assert.match(await page.textContent("[data-part=plan]"), /of 999 runs asked for are done; next: decay/);
  await page.keyboard.press("d");
  assert.equal(await page.getAttribute("html", "data-theme"), "dark");
  await page.keyboard.press("d");
}
