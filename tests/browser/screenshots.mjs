// Pictures of a page at the widths that are looked at: node screenshots.mjs PAGE FOLDER [TICK]
import { Browser } from "./cdp.mjs";
import { pathToFileURL } from "node:url";
import { join } from "node:path";

const [address, folder, tick = "60"] = process.argv.slice(2);
const url = address.includes("://") ? address : pathToFileURL(address).href;
const browser = await Browser.open();
for (const [width, dark] of [[1280, false], [420, false], [1280, true]]) {
  const page = await browser.page(url, width, dark);
  await page.eval(`typeof goTo === "function" ? goTo(${tick}) : 0`);
  await page.screenshot(join(folder, `${width}${dark ? "-dark" : ""}.png`));
  page.errors.forEach(error => console.error(error));
}
await browser.close();
