// Frame time of the live page at eight channels of 1 kHz: what the page itself measures.
// rolltank bench page --hold 60, then, in the folder of the packages:
// CHROMIUM=/usr/bin/chromium node tests/browser/frame_time.mjs ADDRESS
import { connected, launch, open } from "./stage.mjs";

const browser = await launch();
const page = await open(browser);
await connected(page);
await page.selectOption("#window", "60");
// Until the charts are full and the page has counted its last three hundred frames.
await page.waitForTimeout(20_000);
console.log(await page.textContent("#figures"));
await browser.close();
process.exit(0);
