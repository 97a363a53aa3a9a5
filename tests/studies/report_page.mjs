// Looks at a page of `lacon report` as a user would, in headless Chromium: node report_page.mjs VIEWER CHROMIUM < steps.
// Steps are lines of JSON; for each a line of JSON is answered.
//   {"open": FILE, "width": ..., "height": ..., "dark": ...}   -> {"seconds"}: until the first view stands
//   {"set": {"field": "CONT_ELEM", ...}}                       -> {}: controls, by their id
//   {"click": [x, y]}, {"key": "]"}                            -> {}: in the picture; x and y in its pixels
//   {"media": "print"}                                         -> {}: as on paper, or "screen"
//   {"ask": "document.title"}                                  -> {"value"}
//   {"picture": true}                                          -> {"width", "height", "pixels"}: of the canvas, base64 of RGB rows from the top
//   {"shot": FILE}                                             -> {}: what is seen, a PNG file
//   {"said": true}                                             -> {"console", "requests"}: so far
import {createInterface} from "node:readline";
import {createRequire} from "node:module";

const [viewer, executablePath] = process.argv.slice(2);
const {chromium} = createRequire(`${viewer}/`)("playwright-core");
const browser = await chromium.launch({executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]});
const said = {console: [], requests: []};
let page = null;

async function settled(act) {
  const before = await page.evaluate(() => document.body.dataset.drawn);
  await act();
  await page.waitForFunction((count) => document.body.dataset.drawn !== count, before, {timeout: 3000}).catch(() => {});
  await page.waitForTimeout(50);
}

const steps = {
  async open({open, width = 900, height = 700, dark = false}) {
    await page?.context().close();
    const context = await browser.newContext({viewport: {width, height}, colorScheme: dark ? "dark" : "light", offline: true});
    page = await context.newPage();
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && said.console.push(message.text()));
    page.on("pageerror", (error) => said.console.push(String(error.stack)));
    page.on("request", (request) => said.requests.push(request.url().slice(0, 80)));
    const start = Date.now();
    await page.goto(`file://${open}`);
    await page.waitForFunction(() => document.body.dataset.ready === "yes", null, {timeout: 60000});
    return {seconds: (Date.now() - start) / 1000};
  },
  async set({set}) {
    for (const [id, value] of Object.entries(set))
      await settled(() => page.evaluate(([name, to]) => {
        const control = document.getElementById(name);
        control[control.type === "checkbox" ? "checked" : "value"] = to;
        for (const kind of ["input", "change"]) control.dispatchEvent(new Event(kind));
      }, [id, value]));
    return {};
  },
  async click({click}) {
    const box = await page.locator("#canvas").boundingBox();
    await settled(() => page.mouse.click(box.x + click[0], box.y + click[1]));
    return {};
  },
  async key({key}) {
    await page.focus("#view");
    await settled(() => page.keyboard.press(key));
    return {};
  },
  async media({media}) {
    await page.emulateMedia({media});
    await page.waitForTimeout(100);
    return {};
  },
  async ask({ask}) {
    return {value: await page.evaluate(ask)};
  },
  async picture() {
    return page.evaluate(() => {
      const canvas = document.querySelector("#canvas canvas");
      window.lacon.scene.render(); // what was drawn earlier is not kept
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext("2d");
      context.drawImage(canvas, 0, 0);
      const {data} = context.getImageData(0, 0, copy.width, copy.height);
      let pixels = "";
      for (let i = 0; i < data.length; i += 4) pixels += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
      return {width: copy.width, height: copy.height, pixels: btoa(pixels)};
    });
  },
  async shot({shot}) {
    await page.screenshot({path: shot});
    return {};
  },
  async said() {
    return said;
  },
};

for await (const line of createInterface({input: process.stdin})) {
  const step = JSON.parse(line);
  const name = Object.keys(steps).find((one) => one in step);
  let answer = {};
  try {
    answer = await steps[name](step);
  } catch (error) {
    answer = {failed: String(error)};
  }
  process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await browser.close();
