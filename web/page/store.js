// What survives a reload, in the browser's own database, on this device: of each tab the state of the page (now) and the best plan of
// a search that is under way (search). A tab keeps its record while it is open, reloads included; a new one begins with what the
// last one left. Where there is no database, nothing is kept.

const KEPT_TABS = 8;

function tabName() {
  try {
    return (sessionStorage.thread ??= `${Date.now()}-${Math.random()}`);
  } catch {
    return `${Date.now()}-${Math.random()}`; // no storage: this tab's until it is reloaded
  }
}

const tab = tabName();

function database() {
  return new Promise((resolve, reject) => {
    const asked = indexedDB.open('thread', 2);
    asked.onupgradeneeded = () => {
      for (const old of [...asked.result.objectStoreNames]) asked.result.deleteObjectStore(old);
      asked.result.createObjectStore('tabs', {keyPath: 'tab'});
    };
    asked.onsuccess = () => resolve(asked.result);
    asked.onerror = () => reject(asked.error);
  });
}

// act(store, done) in one transaction: what it hands to done.
async function inStore(act) {
  const opened = await database();
  return new Promise((resolve, reject) => {
    const transaction = opened.transaction('tabs', 'readwrite');
    let result;
    act(transaction.objectStore('tabs'), (value) => (result = value));
    transaction.oncomplete = () => {
      opened.close();
      resolve(result);
    };
    transaction.onabort = () => reject(transaction.error);
  });
}

const keep = (record, state) =>
  inStore((store) => {
    const asked = store.get(tab);
    asked.onsuccess = () => store.put({...asked.result, tab, time: Date.now(), [record]: state});
  }).catch(() => {});

// {now, search} of this tab, or else of the last one that kept something; the oldest records are dropped.
const kept = () =>
  inStore((store, done) => {
    const asked = store.getAll();
    asked.onsuccess = () => {
      const all = asked.result.sort((a, b) => b.time - a.time);
      for (const {tab: old} of all.slice(KEPT_TABS)) store.delete(old);
      done(all.find((record) => record.tab === tab) || all[0] || {});
    };
  }).catch(() => ({}));
