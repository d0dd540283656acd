// What survives a reload: one record in the browser's own database, on this device. Where there is none, nothing is kept.

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

const keepState = (state) => inStore('readwrite', (store) => store.put(state, 'now')).catch(() => {});
const keptState = () => inStore('readonly', (store) => store.get('now')).catch(() => undefined);
