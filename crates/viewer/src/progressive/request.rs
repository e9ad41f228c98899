//! Requests of the interface and results of the threads: one lock, held for as long as it takes to move a pointer.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use hairline_document::description::Description;
use hairline_image::FilePath;
use web_time::Instant;

use super::{Backend, Built, Event, Frame, View, Wake};

/// A description that waits to be built.
pub(super) struct WantedScene {
    pub revision: u64,
    pub description: Arc<Description>,
    pub base_dir: FilePath,
    pub asked: Instant,
}

#[derive(Default)]
struct State {
    wanted_scene: Option<WantedScene>,
    /// Folder from which the paths of the newest description start.
    base_dir: FilePath,
    is_building: bool,
    built: Option<Arc<Built>>,
    /// Sketch of a newer description than that of `built`.
    sketch: Option<Arc<Built>>,
    view: Option<View>,
    frame: Option<Arc<Frame>>,
    /// The newest picture of a region.
    region_frame: Option<Arc<Frame>>,
    events: Vec<Event>,
    /// Revision of the newest scene that the interface ordered.
    asked: u64,
    /// Revision of the newest scene that was forgotten, and with it all before.
    forgotten: u64,
    /// The revision of the last one that could not be built.
    failed: Option<u64>,
    /// The interface waits for a frame.
    is_awaited: bool,
}

impl State {
    /// Order to be painted now, if scene and view are there.
    fn order(&self) -> Option<Order> {
        Some(Order {
            built: Arc::clone(self.sketch.as_ref().or(self.built.as_ref())?),
            view: self.view?,
            is_region: false,
        })
    }

    /// Wants the scene built anew where the view came so near, or went so far away, that it takes other pieces of the scratches. What is there is
    /// shown until then.
    fn want_pieces_for_view(&mut self) {
        let (Some(built), Some(view), None) = (&self.built, &self.view, &self.wanted_scene) else {
            return;
        };
        if built.revision == self.asked && !built.scratches.serves(&view.camera, view.size_px) {
            self.wanted_scene = Some(WantedScene {
                revision: built.revision,
                description: Arc::clone(&built.description),
                base_dir: self.base_dir.clone(),
                asked: Instant::now(),
            });
        }
    }

    /// Whether the newest picture shows the current view and the scene of this revision.
    #[cfg(not(target_arch = "wasm32"))]
    fn has_frame_of(&self, revision: u64) -> bool {
        self.frame.as_ref().is_some_and(|frame| {
            let wanted = self.view.as_ref();
            frame.built.revision == revision
                && wanted.is_none_or(|view| frame.view.has_same_pixels(view))
        })
    }
}

pub(super) struct Shared {
    state: Mutex<State>,
    /// Signals something new.
    news: Condvar,
    stopped: AtomicBool,
    resting: AtomicBool,
    paused: AtomicBool,
    backend: Mutex<Backend>,
    wake: Wake,
}

/// Order for the painter.
#[derive(Clone)]
pub(super) struct Order {
    pub built: Arc<Built>,
    pub view: View,
    /// Whether the view is that of a region alone.
    pub is_region: bool,
}

impl Order {
    /// Whether a picture of `other` has the same radiances; exposure and tone curve may differ.
    pub fn has_same_pixels(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.built, &other.built) && self.view.has_same_pixels(&other.view)
    }

    /// Whether the orders are the same, with exposure, tone curve, region and all.
    pub fn is_same(&self, other: &Self) -> bool {
        self.has_same_pixels(other)
            && self.view.is_shown_as(&other.view)
            && self.view.region == other.view.region
    }

    /// The order for the region of the view, if it has one. A sketch has none: what it is a sketch of is on the way.
    pub fn of_region(&self) -> Option<Self> {
        let view = self.view.of_region().filter(|_| !self.built.is_sketch())?;
        Some(Self {
            built: Arc::clone(&self.built),
            view,
            is_region: true,
        })
    }
}

impl Shared {
    pub fn new(backend: Backend, wake: Wake) -> Self {
        Self {
            state: Mutex::default(),
            news: Condvar::new(),
            stopped: AtomicBool::new(false),
            resting: AtomicBool::new(false),
            paused: AtomicBool::new(false),
            backend: Mutex::new(backend),
            wake,
        }
    }

    /// A thread that panicked left nothing half-moved: each lock covers one move.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Blocks while something `is_missing`, until `patience` is over.
    fn wait_while<'a>(
        &self,
        state: MutexGuard<'a, State>,
        patience: Duration,
        is_missing: impl Fn(&State) -> bool,
    ) -> MutexGuard<'a, State> {
        self.news
            .wait_timeout_while(state, patience, |state| is_missing(state))
            .unwrap_or_else(PoisonError::into_inner)
            .0
    }

    pub fn want_scene(&self, revision: u64, description: Arc<Description>, base_dir: FilePath) {
        let mut state = self.lock();
        state.asked = revision;
        state.base_dir.clone_from(&base_dir);
        state.wanted_scene = Some(WantedScene {
            revision,
            description,
            base_dir,
            asked: Instant::now(),
        });
        drop(state);
        self.news.notify_all();
    }

    pub fn forget_scene(&self) {
        let mut state = self.lock();
        state.forgotten = state.asked;
        (state.built, state.sketch) = (None, None);
        (state.frame, state.region_frame) = (None, None);
        drop(state);
        self.news.notify_all();
    }

    pub fn want_view(&self, view: View) {
        let mut state = self.lock();
        if state.view != Some(view) {
            state.view = Some(view);
            state.want_pieces_for_view();
            drop(state);
            self.news.notify_all();
        }
    }

    pub fn view(&self) -> Option<View> {
        self.lock().view
    }

    /// Whether a finer picture of `order` is outdated, or to be shown by another exposure first. One that is painted `on_cores` also gives way to the building of a newer scene, which would
    /// wait for the same cores; it goes on if the building fails.
    pub fn is_outdated(&self, order: &Order, on_cores: bool) -> bool {
        let state = self.lock();
        let is_building = state.is_building || state.wanted_scene.is_some();
        let newest = match order.is_region {
            true => state.order().and_then(|newest| newest.of_region()),
            false => state.order(),
        };
        on_cores && is_building || newest.is_none_or(|newest| !newest.is_same(order))
    }

    /// Takes the scene that is to be built next, if there is one.
    pub fn take_scene(&self) -> Option<WantedScene> {
        self.lock().wanted_scene.take()
    }

    /// Blocks, which only a thread may: until there is a scene to build; none when it is time to end.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn next_scene(&self) -> Option<WantedScene> {
        let mut state = self.lock();
        state.is_building = false;
        let mut state = self.wait_while(state, Duration::MAX, |state| {
            state.wanted_scene.is_none() && !self.is_stopped()
        });
        let wanted = state.wanted_scene.take_if(|_| !self.is_stopped());
        state.is_building = wanted.is_some();
        wanted
    }

    /// Whether there is an order for a newer scene than the one in hand.
    pub fn wants_scene(&self) -> bool {
        self.lock().wanted_scene.is_some()
    }

    /// Blocks until there is an order for a newer scene, it is time to end, or `patience` is over. Returns at once where there are no threads.
    pub fn wait_for_scene(&self, patience: Duration) {
        if cfg!(target_arch = "wasm32") {
            return;
        }
        drop(self.wait_while(self.lock(), patience, |state| {
            state.wanted_scene.is_none() && !self.is_stopped()
        }));
    }

    /// Something to paint until all of the scene is there; nobody else is shown it.
    pub fn put_sketch(&self, sketch: Built) {
        let mut state = self.lock();
        if sketch.revision <= state.forgotten {
            return;
        }
        state.sketch = Some(Arc::new(sketch));
        drop(state);
        self.news.notify_all();
    }

    /// Drops a sketch of a scene that cannot be built: the last good scene stays.
    pub fn drop_sketch(&self) {
        self.lock().sketch = None;
    }

    pub fn put_built(&self, built: Built) {
        let mut state = self.lock();
        if built.revision <= state.forgotten {
            return;
        }
        state.sketch = None;
        state.built = Some(Arc::new(built));
        state.want_pieces_for_view();
        drop(state);
        self.news.notify_all();
        (self.wake)();
    }

    /// Order to be painted now, if scene and view are there.
    pub fn order(&self) -> Option<Order> {
        self.lock().order()
    }

    /// Blocks, which only a thread may: until the order is another one than `done`, or until `patience` is over; none when it is time to end.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn next_order(&self, done: Option<&Order>, patience: Option<Duration>) -> Option<Order> {
        let is_done = |order: Order| done.is_some_and(|done| done.is_same(&order));
        let patience = patience.unwrap_or(Duration::MAX);
        let state = self.wait_while(self.lock(), patience, |state| {
            !self.is_stopped() && state.order().is_none_or(is_done)
        });
        // A scene that is forgotten in the middle of its picture leaves no order until the next one is built.
        let state = self.wait_while(state, Duration::MAX, |state| {
            !self.is_stopped() && state.order().is_none()
        });
        state.order().filter(|_| !self.is_stopped())
    }

    pub fn put_frame(&self, frame: Frame) {
        let mut state = self.lock();
        if frame.built.revision <= state.forgotten {
            return;
        }
        state.frame = Some(Arc::new(frame));
        let is_awaited = state.is_awaited;
        drop(state);
        self.tell(is_awaited);
    }

    pub fn put_region_frame(&self, frame: Frame) {
        let mut state = self.lock();
        if frame.built.revision <= state.forgotten {
            return;
        }
        state.region_frame = Some(Arc::new(frame));
        let is_awaited = state.is_awaited;
        drop(state);
        self.tell(is_awaited);
    }

    /// The newest picture of the region that is wanted, until the whole picture is as fine.
    pub fn region_frame(&self) -> Option<Arc<Frame>> {
        let state = self.lock();
        let wanted = state.order()?.of_region()?;
        let part = state.region_frame.clone()?;
        let is_wanted = Arc::ptr_eq(&part.built, &wanted.built)
            && part.view.has_same_pixels(&wanted.view)
            && part.view.is_shown_as(&wanted.view);
        let whole = &state.frame.as_ref()?.painted;
        let is_finer = !whole.is_final && part.painted.samples > whole.samples
            || whole.size_px != state.view?.size_px
            || whole.thin > 1;
        (is_wanted && is_finer).then_some(part)
    }

    pub fn put_event(&self, event: Event) {
        let mut state = self.lock();
        if let Event::NotBuilt { revision, .. } = event {
            state.failed = Some(revision);
        }
        state.events.push(event);
        let is_awaited = state.is_awaited;
        drop(state);
        self.tell(is_awaited);
    }

    /// Makes the interface take the newest results.
    #[cfg(target_arch = "wasm32")]
    pub fn wake(&self) {
        (self.wake)();
    }

    /// Tells the interface of news. One that waits needs no further pass to see them.
    fn tell(&self, is_awaited: bool) {
        if is_awaited {
            self.news.notify_all();
        } else {
            (self.wake)();
        }
    }

    /// Blocks until there is a frame of the current view and of this revision, an event, or until `patience` is over.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait_for_frame(&self, revision: u64, patience: Duration) {
        let mut state = self.lock();
        state.is_awaited = true;
        let mut state = self.wait_while(state, patience, |state| {
            !state.has_frame_of(revision) && state.events.is_empty()
        });
        state.is_awaited = false;
    }

    pub fn frame(&self) -> Option<Arc<Frame>> {
        self.lock().frame.clone()
    }

    pub fn built(&self) -> Option<Arc<Built>> {
        self.lock().built.clone()
    }

    pub fn is_building(&self) -> bool {
        let state = self.lock();
        state.is_building || state.wanted_scene.is_some()
    }

    pub fn has_failed(&self) -> bool {
        let state = self.lock();
        state.failed == Some(state.asked)
    }

    pub fn take_events(&self) -> Vec<Event> {
        std::mem::take(&mut self.lock().events)
    }

    pub fn backend(&self) -> Backend {
        self.backend
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    pub fn set_backend(&self, backend: Backend) {
        *self.backend.lock().unwrap_or_else(PoisonError::into_inner) = backend;
    }

    pub fn is_resting(&self) -> bool {
        self.resting.load(Ordering::Relaxed)
    }

    pub fn set_resting(&self, is_resting: bool) {
        self.resting.store(is_resting, Ordering::Relaxed);
    }

    pub fn is_paused(&self) -> bool {
        self.paused.load(Ordering::Relaxed)
    }

    pub fn set_paused(&self, is_paused: bool) {
        self.paused.store(is_paused, Ordering::Relaxed);
    }

    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    pub fn stop(&self) {
        // Under the lock, lest a thread that has just looked should sleep through the call.
        let state = self.lock();
        self.stopped.store(true, Ordering::Relaxed);
        drop(state);
        self.news.notify_all();
    }
}
