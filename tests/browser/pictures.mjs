// Pictures of every view in light and dark, of the report, of a question, of an alarm, of a tablet.
// rolltank demo --speed 10 --listen 127.0.0.1:8440, and when some runs are there, in the folder of
// the packages: CHROMIUM=/usr/bin/chromium node tests/browser/pictures.mjs 127.0.0.1:8440 docs/page
import { VIEWS, address, connected, launch, open, rest, show } from "./stage.mjs";

const [folder] = rest;
const browser = await launch();
const viewport = { width: 1100, height: 760 };

async function ready(options) {
  const page = await open(browser, { viewport, ...options });
  await connected(page);
  // The strips are filled from the past, the views from what was learnt.
  await page.waitForTimeout(1500);
  return page;
}

for (const colorScheme of ["light", "dark"]) {
  const page = await ready({ colorScheme });
  const picture = (name) => page.screenshot({ path: `${folder}/${name}-${colorScheme}.png` });
  for (const view of VIEWS) {
    await show(page, view);
    await page.waitForTimeout(300);
    await picture(view);
  }
  const report = await open(browser, { viewport, colorScheme }, `http://${address}/results/index.html`);
  await report.screenshot({ path: `${folder}/report-${colorScheme}.png` });
  await show(page, "runs");
  await page.click("button[data-act=reject]");
  await page.fill("#act-by", "C. Costa");
  await page.fill("#act-why", "a hand touched the model");
  await picture("question");
  await page.click("#act-yes");
  await page.waitForSelector("button[data-act=accept]");
  await show(page, "now");
  await page.click("#record");
  await page.fill("#act-why", "lunch");
  await page.click("#act-yes");
  await page.waitForSelector("#alarms .alarm");
  await page.waitForTimeout(500);
  await page.evaluate(() => window.scrollTo(0, 0));
  await picture("alarm");
  await page.click("#told button[data-act=undo]");
  await page.click("#act-yes");
  await page.waitForSelector("#recording[data-state=good]");
  for (const complaint of page.complaints) console.error(complaint);
}
const tablet = await ready({ viewport: { width: 820, height: 1180 } });
await tablet.screenshot({ path: `${folder}/tablet-light.png` });
await browser.close();
process.exit(0);
