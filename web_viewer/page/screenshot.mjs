// Pictures of the page, dark and light.
//   node screenshot.mjs LIBRARIES CHROMIUM URL OUTPUT_FOLDER NUM_OBJECTS
import {launchBrowser, openPage, waitForObjects} from './browser.mjs';

const [libraries, chromium, url, folder, count] = process.argv.slice(2);
const browser = await launchBrowser(libraries, chromium);
try {
  for (const [colorScheme, name] of [['dark', 'web.png'], ['light', 'web_light.png']]) {
    const context = await browser.newContext({colorScheme, viewport: {width: 1360, height: 800}});
    context.setDefaultTimeout(150_000);
    const {page, errors} = await openPage(context, url);
    await waitForObjects(page, Number(count));
    await page.locator('#objects button').first().dispatchEvent('click');
    if (colorScheme === 'light') await page.locator('#layer-ghosts').dispatchEvent('click');
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
    await page.screenshot({path: `${folder}/${name}`});
    if (errors.length > 0) throw new Error(errors.join('\n'));
    await context.close();
  }
} finally {
  await browser.close();
}
