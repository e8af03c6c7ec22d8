// Who this tab is: a name that it keeps when it is loaded again, and that no other tab has.

const NAME = "ringlet-client";
const WAIT = 500; // for the page that was here before, if this tab was loaded again [ms]

export interface Client {
  name: string;
  /** Whether this tab began as the copy of another, with all that was stored in it. */
  copied: boolean;
}

/**
 * The name of this tab. A browser copies what a tab has stored into a duplicate of it, so a name is held by a lock of the
 * browser. Without locks, which an address without encryption does not have, tabs ask one another.
 */
export async function identify(): Promise<Client> {
  const known = sessionStorage.getItem(NAME);
  if (known && (await hold(known))) return { name: known, copied: false };
  const name = crypto.getRandomValues(new Uint32Array(3)).join("-");
  sessionStorage.setItem(NAME, name);
  await hold(name);
  return { name, copied: known !== null };
}

/** Holds a name for as long as this page lives; false: another page does. */
function hold(name: string): Promise<boolean> {
  return navigator.locks ? holdLock(`${NAME}:${name}`) : claim(name);
}

function holdLock(name: string): Promise<boolean> {
  return new Promise((resolve) => {
    const held = () => {
      resolve(true);
      return new Promise<never>(() => {}); // the lock ends with the page
    };
    navigator.locks.request(name, { signal: AbortSignal.timeout(WAIT) }, held).catch(() => resolve(false));
  });
}

/** Asks all tabs whether one has the name, and answers those that ask later. */
function claim(name: string): Promise<boolean> {
  const tabs = new BroadcastChannel(NAME);
  return new Promise((resolve) => {
    let own = false;
    const timer = setTimeout(() => {
      own = true;
      resolve(true);
    }, WAIT / 5);
    tabs.onmessage = ({ data }: MessageEvent<{ name: string; taken: boolean }>) => {
      if (data.name !== name) return;
      if (own && !data.taken) tabs.postMessage({ name, taken: true });
      else if (!own && data.taken) {
        clearTimeout(timer);
        tabs.close();
        resolve(false);
      }
    };
    tabs.postMessage({ name, taken: false });
  });
}
