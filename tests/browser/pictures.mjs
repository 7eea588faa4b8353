// Pictures of every view in light and dark, at a desk and on a tablet.
// node tests/browser/pictures.mjs ADDRESS FOLDER, from target/browser
import { VIEWS, address, connected, launch, open, rest, show } from "./stage.mjs";

const [folder] = rest;
const browser = await launch();
for (const colorScheme of ["light", "dark"]) {
  const page = await open(browser, { colorScheme });
  await connected(page);
  await page.waitForTimeout(1500);
  for (const view of VIEWS) {
    await show(page, view);
    await page.waitForTimeout(300);
    await page.screenshot({ path: `${folder}/${view}-${colorScheme}.png` });
  }
  for (const line of page.complaints) console.error(line);
}
const tablet = await open(browser, { viewport: { width: 820, height: 1180 } });
await connected(tablet);
await tablet.waitForTimeout(1500);
await tablet.screenshot({ path: `${folder}/now-tablet.png` });
await browser.close();
console.log(address, "pictured");
process.exit(0);
