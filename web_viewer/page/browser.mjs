// A headless Chromium of the system, for tests and pictures of the page.
import {createRequire} from 'node:module';

/** libraries: the folder that build.sh works in. Software rendering: a graphics card is not needed. */
export async function launchBrowser(libraries, chromium) {
  const {chromium: browserType} = createRequire(`${libraries}/`)('playwright-core');
  return browserType.launch({
    executablePath: chromium,
    chromiumSandbox: false,  // it may run as root, in a container
    args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'],
  });
}

/** Opens the page and returns it with the list of what went wrong in it so far. */
export async function openPage(context, url) {
  const page = await context.newPage();
  const errors = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') errors.push(message.text());
  });
  await page.goto(url);
  return {page, errors};
}

/** Waits until as many objects are found for good, and their models' surfaces have come. */
export async function waitForObjects(page, count, timeout = 150_000) {
  await page.waitForFunction((wanted) => {
    const list = document.getElementById('objects');
    return list.dataset.state === 'final' && list.children.length === wanted &&
        document.body.dataset.waiting === '0';
  }, count, {timeout});
}
