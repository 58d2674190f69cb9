/*!
Devices: where drawing happens, and what they can do.

A [`Gpu`] is made for itself ([`Gpu::new`]) or of a device that a program already has
([`Gpu::from_device`]). In both cases nothing is asked for that drawing can do without: what the
adapter has beyond WebGPU is used where it is there. Of a user's own device, neither the handler of
errors nor the callback for its loss is touched.
*/

use crate::{Error, kernel::shader};
use std::sync::{Arc, Mutex, PoisonError};
use wgpu::{ErrorFilter, Features, Limits};

/// A device, its queue, and what they can do. Clones are handles of the same device.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    name: String,
    lost: Arc<Mutex<Option<String>>>,
}

/// What drawing makes use of where it is there.
pub(crate) const WANTED: Features = Features::SHADER_INT64
    .union(Features::SHADER_INT64_ATOMIC_MIN_MAX)
    .union(Features::SHADER_INT64_ATOMIC_ALL_OPS)
    .union(Features::SHADER_EARLY_DEPTH_TEST)
    .union(Features::EXPERIMENTAL_MESH_SHADER);

/// What may be used of what an adapter has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// Everything that makes drawing faster.
    #[default]
    Full,
    /// Only what every WebGPU adapter has, within the default limits.
    Core,
}

impl Gpu {
    /// The device of the first adapter whose name contains `name` (in whatever case), or of the best
    /// one.
    ///
    /// # Errors
    ///
    /// [`Error::NoAdapter`] or [`Error::NoDevice`].
    pub fn new(name: Option<&str>, extent: Extent) -> Result<Self, Error> {
        pollster::block_on(Self::request(name, extent))
    }

    async fn request(name: Option<&str>, extent: Extent) -> Result<Self, Error> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let (adapter, reason) = match name {
            None => match instance.request_adapter(&preferred()).await {
                Ok(adapter) => (Some(adapter), String::new()),
                Err(error) => (None, error.to_string()),
            },
            Some(name) => {
                let all = instance.enumerate_adapters(wgpu::Backends::all()).await;
                let wanted = name.to_lowercase();
                let has_name = |a: &wgpu::Adapter| label(a).to_lowercase().contains(&wanted);
                (all.into_iter().find(has_name), String::new())
            }
        };
        let Some(adapter) = adapter else {
            let known: Vec<String> = names(&instance).await;
            let known = if known.is_empty() { "none".to_owned() } else { known.join("; ") };
            let wanted = name.map_or_else(String::new, |name| format!("with {name:?} in its name"));
            return Err(Error::NoAdapter { wanted, known, reason });
        };
        Self::from_adapter(&adapter, extent).await
    }

    async fn from_adapter(adapter: &wgpu::Adapter, extent: Extent) -> Result<Self, Error> {
        let name = label(adapter);
        let descriptor = match extent {
            Extent::Core => wgpu::DeviceDescriptor {
                label: Some("puncta"),
                required_limits: Limits::default(),
                ..Default::default()
            },
            Extent::Full => full(adapter),
        };
        let no_device = |error: wgpu::RequestDeviceError| Error::NoDevice {
            adapter: name.clone(),
            reason: error.to_string(),
        };
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(no_device)?;
        let gpu = Self { device, queue, name, lost: Arc::default() };
        let lost = Arc::clone(&gpu.lost);
        gpu.device.set_device_lost_callback(move |why, what| {
            let reason = format!("{why:?} {what}").trim().to_owned();
            *lost.lock().unwrap_or_else(PoisonError::into_inner) = Some(reason);
        });
        Ok(gpu)
    }

    /// A device that a program has, to draw beside what the program draws. Its queue must be its own.
    #[must_use]
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = device.adapter_info();
        Self { device, queue, name: describe(&info), lost: Arc::default() }
    }

    /// The names of the adapters that there are.
    #[must_use]
    pub fn adapters() -> Vec<String> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        pollster::block_on(names(&instance))
    }

    /// The name of the adapter, and of its driver.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The device.
    #[must_use]
    pub const fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    #[must_use]
    pub const fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// The features to ask a user's own device for, of those that its adapter has: drawing is faster
    /// with them.
    #[must_use]
    pub fn useful_features(adapter: &wgpu::Adapter) -> Features {
        adapter.features() & (WANTED - Features::EXPERIMENTAL_MESH_SHADER)
    }

    pub(crate) fn has(&self, features: Features) -> bool {
        self.device.features().contains(features)
    }

    /// Whether pixels are written as words of 64 bits.
    pub(crate) fn is_wide(&self) -> bool {
        self.has(Features::SHADER_INT64 | Features::SHADER_INT64_ATOMIC_MIN_MAX)
    }

    /// How pixels are written.
    pub(crate) fn visibility(&self) -> &'static str {
        if !self.is_wide() {
            shader!("visibility_narrow")
        } else if self.has(Features::SHADER_INT64_ATOMIC_ALL_OPS) {
            shader!("visibility_load")
        } else {
            shader!("visibility_wide")
        }
    }

    /// Whether a processor stands in for a GPU.
    pub(crate) fn is_cpu(&self) -> bool {
        self.device.adapter_info().device_type == wgpu::DeviceType::Cpu
    }

    /// The bytes that the lanes of a group may share.
    pub(crate) fn group_bytes(&self) -> u32 {
        self.device.limits().max_compute_workgroup_storage_size
    }

    /// The most bytes that a shader sees in one piece.
    pub(crate) fn binding_bytes_max(&self) -> u64 {
        let limits = self.device.limits();
        let binding = limits.max_storage_buffer_binding_size;
        binding.min(limits.max_buffer_size) / 256 * 256
    }

    /// Does something, and gives what the device refuses of it as an error. `what` says what memory
    /// was for.
    pub(crate) fn guard<T>(&self, what: &str, work: impl FnOnce() -> T) -> Result<T, Error> {
        let memory = self.device.push_error_scope(ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(ErrorFilter::Internal);
        let validation = self.device.push_error_scope(ErrorFilter::Validation);
        let result = work();
        let refused = pollster::block_on(validation.pop()).or(pollster::block_on(internal.pop()));
        let memory = pollster::block_on(memory.pop());
        self.check()?;
        if memory.is_some() {
            return Err(Error::OutOfMemory { what: what.to_owned() });
        }
        match refused {
            Some(error) if self.is_gone() => Err(Error::Lost { reason: error.to_string() }),
            Some(error) => Err(Error::Refused { what: error.to_string() }),
            None => Ok(result),
        }
    }

    /// Whether the device can do nothing any more, found by trying: of a user's own device it is not
    /// told. What is made on a lost device is no error, but it cannot be used.
    fn is_gone(&self) -> bool {
        let validation = self.device.push_error_scope(ErrorFilter::Validation);
        let probe = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Gpu::probe"),
            size: 16,
            usage: wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        probe.map_async(wgpu::MapMode::Read, .., |_| {});
        pollster::block_on(validation.pop()).is_some()
    }

    /// Whether the device is still there.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match &*self.lost.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(reason) => Err(Error::Lost { reason: reason.clone() }),
            None => Ok(()),
        }
    }

    /// Waits until all that was submitted is done.
    pub(crate) fn wait(&self) -> Result<(), Error> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map_err(|error| Error::Lost { reason: error.to_string() })?;
        Ok(())
    }
}

fn full(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let features = adapter.features() & WANTED;
    let has_mesh = features.contains(Features::EXPERIMENTAL_MESH_SHADER);
    wgpu::DeviceDescriptor {
        label: Some("puncta"),
        required_features: features,
        required_limits: adapter.limits(),
        experimental_features: if has_mesh { experimental() } else { Default::default() },
        ..Default::default()
    }
}

/// Mesh shaders are marked as experimental: wgpu does not vouch that every use of them is sound.
#[expect(unsafe_code, reason = "mesh shaders can be had in no other way")]
pub(crate) fn experimental() -> wgpu::ExperimentalFeatures {
    // SAFETY: what is drawn with them is drawn by one small shader, which writes within its arrays,
    // and only on adapters that name the feature.
    unsafe { wgpu::ExperimentalFeatures::enabled() }
}

fn preferred() -> wgpu::RequestAdapterOptions<'static, 'static> {
    wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    }
}

async fn names(instance: &wgpu::Instance) -> Vec<String> {
    instance.enumerate_adapters(wgpu::Backends::all()).await.iter().map(label).collect()
}

fn label(adapter: &wgpu::Adapter) -> String {
    describe(&adapter.get_info())
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    let driver = if info.driver_info.is_empty() { &info.driver } else { &info.driver_info };
    format!("{} ({:?}, {driver})", info.name, info.backend)
}
