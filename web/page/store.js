// What survives a reload, in the browser's own database, on this device: the state of the page, and the best plan of a search that is
// under way. Where there is no database, nothing is kept.

function database() {
  return new Promise((resolve, reject) => {
    const asked = indexedDB.open('thread', 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore('state');
    asked.onsuccess = () => resolve(asked.result);
    asked.onerror = () => reject(asked.error);
  });
}

async function inStore(mode, act) {
  const opened = await database();
  return new Promise((resolve, reject) => {
    const request = act(opened.transaction('state', mode).objectStore('state'));
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

const keep = (record, state) => inStore('readwrite', (store) => store.put(state, record)).catch(() => {});
const kept = (record) => inStore('readonly', (store) => store.get(record)).catch(() => undefined);
